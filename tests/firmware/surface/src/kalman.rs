//! Calls everything of `kestirim-kalman`.

use kestirim_kalman::{
    BlockInnovation, ConstantVelocity, Covariance, Driven, Gate, Gaussian, Innovation, Linear,
    LinearObservation, Observation, Process, SparseRow, SteadyState, Weighed, steady_state,
};
use kestirim_scalar::{Q12_20, Scalar};

use super::values::{
    LONG_FORM, any, call_each, keep, matrix, maybe, number, numbers, option, rounds, slice, try_on,
    whole,
};

fn estimate<T: Scalar, const N: usize>() -> Gaussian<T, N> {
    any(Gaussian::new(matrix(), Covariance::from_variances(&numbers())))
}

fn row<T: Scalar, const K: usize>() -> SparseRow<T, K> {
    any(SparseRow::new([(whole(), number()); K]))
}

fn covariances<T: Scalar, const N: usize>() {
    keep::<Covariance<T, N>>(Covariance::zero());
    let mut covariance = any(Covariance::<T, N>::from_lower_triangle(&matrix()));
    keep(Covariance::to_matrix(&covariance));
    keep(Covariance::get(&covariance, whole(), whole()));
    keep(Covariance::variances(&covariance));
    keep(Covariance::is_finite(&covariance));
    Covariance::add(any(&mut covariance), &Covariance::from_variances(&numbers()));
    Covariance::blend(any(&mut covariance), &Covariance::from_variances(&numbers()), number());
    Covariance::scale(any(&mut covariance), number());
    Covariance::add_outer(any(&mut covariance), &matrix());
    Covariance::add_variance::<1>(any(&mut covariance), number());
    Covariance::shear::<0, 1>(any(&mut covariance), number());
    Covariance::reset_component::<1>(any(&mut covariance), number());
    keep(Covariance::transformed(&covariance, &matrix()));
    try_on(&mut covariance, |covariance| {
        Covariance::inflate(covariance, whole(), whole(), number())
    });
}

fn predictions<T: Scalar, const N: usize>() {
    let mut state = estimate::<T, N>();
    let (f, q) = (matrix(), any(Covariance::from_variances(&numbers())));
    try_on(&mut state, |state| Gaussian::predict(state, &f, &q));
    let linear = Linear { f: &f, q: &q };
    try_on(&mut state, |state| Gaussian::advance(state, &linear));
    <Linear<'_, T, N> as Process<T, N>>::advance(&linear, any(&mut state));
    let (rows, fading) = (matrix::<T, 2, 2>(), numbers());
    let driven = any(Driven { rows: &rows, fading: &fading, noise: &q });
    try_on(&mut state, |state| Gaussian::advance(state, &driven));
    <Driven<'_, T, N, 2, 2> as Process<T, N>>::advance(&driven, any(&mut state));
    try_on(&mut state, |state| Gaussian::add_variance_at(state, whole(), number()));
    try_on(&mut state, |state| Gaussian::reset_at(state, whole(), number(), number()));
}

fn motions<T: Scalar, const D: usize, const N: usize>() {
    let mut state = estimate::<T, N>();
    let motion = ConstantVelocity::new(number(), number());
    let decay_time = option();
    let acceleration = maybe(numbers::<T, D>());
    let motion = any(ConstantVelocity::<T, D> { decay_time, acceleration, ..motion });
    <ConstantVelocity<T, D> as Process<T, N>>::advance(&motion, any(&mut state));
    try_on(&mut state, |state| Gaussian::advance(state, &motion));
}

fn updates<T: Scalar, const N: usize, const K: usize>() {
    let mut state = estimate::<T, N>();
    let row = row::<T, K>();
    keep(SparseRow::entries(&row));
    keep(SparseRow::dot(&row, &state.mean));
    keep(SparseRow::as_ref(&row));
    let observation = any(LinearObservation { row, measured: number() });
    keep(<LinearObservation<T, K> as Observation<T, N>>::linearise(&observation, &state.mean));
    try_on(&mut state, |state| Gaussian::observe(state, &observation, number()));
    keep(Gaussian::weigh_observation(&state, &observation, number()));
    try_on(&mut state, |state| Gaussian::update(state, &row, number(), number()));
    try_on(&mut state, |state| Gaussian::update_component::<1>(state, number(), number()));
    let entries = [(whole(), number()); K];
    keep(Gaussian::weigh_entries(&state, slice(&entries), number(), number()));
    keep(Gaussian::weigh_row(&state, &numbers(), number(), number()));
    let Ok(weighed) = Gaussian::weigh(&state, &row, number(), number()) else { return };
    weights(&mut state, any(weighed));
}

fn weights<T: Scalar, const N: usize>(state: &mut Gaussian<T, N>, weighed: Weighed<T, N>) {
    keep(Weighed::innovation(&weighed));
    keep(Weighed::spread(&weighed));
    keep(Weighed::noise(&weighed));
    keep(Weighed::variance(&weighed));
    keep(Weighed::by_variance(&weighed, number()));
    keep(Weighed::cross_covariance(&weighed));
    keep(Weighed::exceeds(&weighed, number()));
    keep::<Innovation<T>>(Weighed::report(&weighed));
    keep(Gaussian::correct(any(state), &weighed));
    keep(Gaussian::correct_widened(any(state), &weighed, number()));
    let mut gate = any(Gate::new(number(), whole()));
    keep(Gate::gamma(&gate));
    keep(Gate::rejected(&gate));
    for _ in 0..rounds() {
        keep(Gate::judge(any(&mut gate), &weighed));
        try_on(&mut gate, |gate| Gate::correct(gate, any(state), &weighed));
    }
    keep(Weighed::with_noise(weighed, number()));
}

fn blocks<T: Scalar, const N: usize, const M: usize>() {
    let mut state = estimate::<T, N>();
    let noise = any(Covariance::<T, M>::from_variances(&numbers()));
    let taken = Gaussian::update_block(any(&mut state), &matrix(), &matrix(), &noise);
    keep::<Result<BlockInnovation<T, M>, _>>(taken);
    let q = any(Covariance::<T, N>::from_variances(&numbers()));
    let settled = steady_state(&matrix(), &q, &matrix(), &noise);
    keep::<Result<SteadyState<T, N, M>, _>>(settled);
}

fn all_of<T: Scalar>() {
    call_each([
        covariances::<T, 4>,
        covariances::<T, 9>,
        predictions::<T, 4>,
        predictions::<T, 9>,
        motions::<T, 2, 4>,
        motions::<T, 3, 9>,
        updates::<T, 4, 2>,
        updates::<T, 9, 5>,
        blocks::<T, 4, 2>,
        blocks::<T, 9, 5>,
    ]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q12_20>]);
}
