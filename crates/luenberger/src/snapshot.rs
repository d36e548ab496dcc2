//! Names and versions of stored estimators. Raise the version whenever the stored form changes.

use crate::{CurrentObserver, DisturbanceObserver, Predictor, ReducedObserver};
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar, const N: usize, const M: usize, const P: usize] for CurrentObserver<T, N, M, P>
        as "observer/current", 1, T, [N, M, P];
    [T: Scalar, const N: usize, const M: usize, const P: usize] for Predictor<T, N, M, P>
        as "observer/predict", 1, T, [N, M, P];
    [T: Scalar, const N: usize, const M: usize, const P: usize, const D: usize] for DisturbanceObserver<T, N, M, P, D>
        as "observer/disturb", 1, T, [N, M, P, D];
    [T: Scalar, const N: usize, const M: usize, const P: usize, const R: usize] for ReducedObserver<T, N, M, P, R>
        as "observer/reduced", 1, T, [N, M, P, R];
}
