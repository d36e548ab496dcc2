//! Calls everything of `kestirim-adaptive-kalman`.

use kestirim_adaptive_kalman::{
    AdaptiveKalman, Error, Learning, MeasurementNoise, ProcessNoise, PublishedAdaptiveKalman,
};
use kestirim_kalman::{ConstantVelocity, Covariance, Gaussian, SparseRow};
use kestirim_scalar::{Q12_20, Scalar};

use super::values::{
    LONG_FORM, any, call_each, keep, matrix, number, numbers, rounds, try_on, whole,
};

fn covariance<T: Scalar, const N: usize>() -> Covariance<T, N> {
    any(Covariance::from_variances(&numbers()))
}

fn learning<T: Scalar>() -> Option<Learning<T>> {
    let learning = any(Learning::new(number(), number(), number()).ok()?);
    keep(Learning::learn(&learning, number(), number()));
    keep(Learning::limited(&learning, number()));
    keep(Learning::raised(&learning, number()));
    keep::<Error>(From::from(any(kestirim_kalman::Error::NotFinite)));
    Some(learning)
}

fn noises<T: Scalar, const N: usize>() {
    let Some(learning) = learning::<T>() else { return };
    let mut process = any(ProcessNoise::<T, N>::new(numbers(), [learning; N]));
    keep(ProcessNoise::variances(&process));
    keep(ProcessNoise::covariance(&process));
    ProcessNoise::learn(any(&mut process), &matrix());
    let mut noise = any(MeasurementNoise::new(number()));
    keep(MeasurementNoise::variance(&noise));
    let estimate = any(Gaussian::<T, N>::new(matrix(), covariance()));
    let row = any(SparseRow::new([(whole(), number())]));
    let Ok(weighed) = estimate.weigh(&row, number(), number()) else { return };
    MeasurementNoise::learn(any(&mut noise), &learning, &weighed);
    MeasurementNoise::learn_square(any(&mut noise), &learning, &weighed, number());
    keep(noise);
}

fn filters<T: Scalar, const D: usize, const N: usize, const M: usize>() {
    let Some(learning) = learning::<T>() else { return };
    let mut filter = any(AdaptiveKalman::<T, N, M>::new(
        Gaussian::new(matrix(), covariance()),
        ProcessNoise::new(numbers(), [learning; N]),
        numbers(),
        [learning; M],
    ));
    let motion = any(ConstantVelocity::<T, D>::new(number(), number()));
    let row = any(SparseRow::new([(any(0), number()), (whole(), number())]));
    for _ in 0..rounds() {
        try_on(&mut filter, |filter| AdaptiveKalman::predict(filter, &motion));
        try_on(&mut filter, |filter| AdaptiveKalman::update(filter, whole(), &row, number()));
        try_on(&mut filter, |filter| {
            AdaptiveKalman::update_without_learning(filter, whole(), &row, number())
        });
    }
    keep(AdaptiveKalman::estimate(&filter));
    keep(AdaptiveKalman::process_noise(&filter));
    keep(AdaptiveKalman::measurement_noise(&filter));
}

fn published<T: Scalar, const D: usize, const N: usize, const M: usize>() {
    let estimate = Gaussian::<T, N>::new(matrix(), covariance());
    let noise = covariance::<T, M>();
    let filter = PublishedAdaptiveKalman::new(estimate, covariance(), noise, number(), number());
    let Ok(mut filter) = any(filter) else { return };
    let motion = any(ConstantVelocity::<T, D>::new(number(), number()));
    try_on(&mut filter, |filter| PublishedAdaptiveKalman::predict(filter, &motion));
    try_on(&mut filter, |filter| PublishedAdaptiveKalman::update(filter, &matrix(), &matrix()));
    keep(PublishedAdaptiveKalman::estimate(&filter));
    keep(PublishedAdaptiveKalman::measurement_noise(&filter));
}

fn all_of<T: Scalar>() {
    call_each([
        noises::<T, 4>,
        noises::<T, 9>,
        filters::<T, 2, 4, 4>,
        filters::<T, 3, 9, 7>,
        published::<T, 2, 4, 4>,
        published::<T, 3, 9, 5>,
    ]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q12_20>]);
}
