//! Snapshot layouts of the estimators. Raise the version of an estimator whose stored form changes.

use crate::{
    AugmentedFilter, AugmentedFlight, Estimator, FlightFilter, FlightObserver, KalmanFilter,
};
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar, const N: usize, const K: usize, const P: usize] for AugmentedFilter<T, N, K, P> as "uav/augmented", 1, T, [N, K, P];
    [T: Scalar, const N: usize, const K: usize, const P: usize, const L: usize]
        for AugmentedFlight<T, N, K, P, L> as "uav/augmented-flight", 1, T, [N, K, P, L];
    [T: Scalar, const P: usize] for Estimator<T, P> as "uav/estimator", 1, T, [P];
    [T: Scalar, const P: usize] for KalmanFilter<T, P> as "uav/kalman", 1, T, [P];
    [T: Scalar, const P: usize, const L: usize] for FlightFilter<T, P, L> as "uav/filter", 2, T, [P, L];
    [T: Scalar, const P: usize, const L: usize] for FlightObserver<T, P, L> as "uav/observer", 1, T, [P, L];
}
