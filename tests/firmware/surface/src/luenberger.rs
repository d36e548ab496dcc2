//! Calls everything of `kestirim-luenberger` that runs on a target. Gains are computed in double precision at compile
//! time: see `surface-luenberger-f64`.

use kestirim_luenberger::{
    CurrentGains, CurrentObserver, DisturbanceGains, DisturbanceObserver, Plant, Predictor,
    PredictorGains, ReducedGains, ReducedObserver, Saturation,
};
use kestirim_scalar::{Q16_16, Scalar};
use nalgebra::{ArrayStorage, SMatrix};

use super::values::{LONG_FORM, any, call_each, keep, matrix, try_on};

const fn filled<const R: usize, const C: usize>() -> SMatrix<f64, R, C> {
    SMatrix::from_array_storage(ArrayStorage([[0.5; R]; C]))
}

/// Gains of every observer for N states, M inputs, P outputs and D disturbances.
struct Gains<const N: usize, const M: usize, const P: usize, const D: usize>;

impl<const N: usize, const M: usize, const P: usize, const D: usize> Gains<N, M, P, D> {
    const PLANT: Plant<N, M, P> = Plant { a: filled(), b: filled(), c: filled() };
    const PREDICTOR: PredictorGains<N, M, P> = PredictorGains::new(&Self::PLANT, &filled());
    const CURRENT: CurrentGains<N, M, P> = CurrentGains::new(&Self::PLANT, &filled());
    const DISTURBANCE: DisturbanceGains<N, M, P, D> =
        DisturbanceGains::new(&Self::PLANT, &filled(), &filled(), &filled(), &filled());
}

/// Gains of a reduced observer with the last two states measured.
const fn reduced<const N: usize, const M: usize, const R: usize>() -> ReducedGains<N, M, 2, R> {
    match ReducedGains::new(&filled(), &filled(), &[N - 1, N - 2], &filled()) {
        Ok(gains) => gains,
        Err(_) => panic!(),
    }
}

fn predictors<T: Scalar, const N: usize, const M: usize, const P: usize>() {
    let gains = any(const { Gains::<N, M, P, 1>::PREDICTOR });
    let Ok(mut observer) = any(Predictor::<T, N, M, P>::new(&gains, &matrix())) else { return };
    try_on(&mut observer, |observer| Predictor::reset(observer, &matrix()));
    try_on(&mut observer, |observer| Predictor::step(observer, &matrix(), &matrix()));
    try_on(&mut observer, |observer| Predictor::coast(observer, &matrix()));
    keep(Predictor::estimate(&observer));
    keep(Predictor::innovation(&observer, &matrix()));
    let Ok(limits) = any(Saturation::<T, M>::new(&matrix(), &matrix())) else { return };
    keep(Saturation::applied(&limits, &matrix()));
}

fn currents<T: Scalar, const N: usize, const M: usize, const P: usize>() {
    let gains = any(const { Gains::<N, M, P, 1>::CURRENT });
    let observer = CurrentObserver::<T, N, M, P>::new(&gains, &matrix());
    let Ok(mut observer) = any(observer) else { return };
    try_on(&mut observer, |observer| CurrentObserver::reset(observer, &matrix()));
    try_on(&mut observer, |observer| CurrentObserver::predict(observer, &matrix()));
    try_on(&mut observer, |observer| CurrentObserver::correct(observer, &matrix()));
    try_on(&mut observer, |observer| CurrentObserver::step(observer, &matrix(), &matrix()));
    keep(CurrentObserver::estimate(&observer));
}

fn disturbances<T: Scalar, const N: usize, const M: usize, const P: usize, const D: usize>() {
    let gains = any(const { Gains::<N, M, P, D>::DISTURBANCE });
    let observer = DisturbanceObserver::<T, N, M, P, D>::new(&gains, &matrix(), &matrix());
    let Ok(mut observer) = any(observer) else { return };
    try_on(&mut observer, |observer| DisturbanceObserver::reset(observer, &matrix(), &matrix()));
    try_on(&mut observer, |observer| DisturbanceObserver::step(observer, &matrix(), &matrix()));
    keep(DisturbanceObserver::estimate(&observer));
    keep(DisturbanceObserver::disturbance(&observer));
    keep(DisturbanceObserver::innovation(&observer, &matrix()));
}

fn reductions<T: Scalar, const N: usize, const M: usize, const R: usize>() {
    let gains = any(const { reduced::<N, M, R>() });
    let observer = ReducedObserver::<T, N, M, 2, R>::new(&gains, &matrix(), &matrix());
    let Ok(mut observer) = any(observer) else { return };
    try_on(&mut observer, |observer| ReducedObserver::reset(observer, &matrix(), &matrix()));
    try_on(&mut observer, |observer| ReducedObserver::step(observer, &matrix(), &matrix()));
    keep(ReducedObserver::unmeasured(&observer, &matrix()));
    keep(ReducedObserver::estimate(&observer, &matrix()));
}

fn all_of<T: Scalar>() {
    call_each([
        predictors::<T, 4, 2, 3>,
        predictors::<T, 9, 3, 5>,
        currents::<T, 4, 2, 3>,
        currents::<T, 9, 3, 5>,
        disturbances::<T, 4, 2, 3, 1>,
        disturbances::<T, 9, 3, 5, 2>,
        reductions::<T, 4, 2, 2>,
        reductions::<T, 9, 3, 7>,
    ]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q16_16>]);
}
