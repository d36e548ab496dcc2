//! Names and versions of stored estimators. Raise the version whenever the stored form changes.

use crate::{AdaptiveKalman, PublishedAdaptiveKalman};
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar, const N: usize, const M: usize] for AdaptiveKalman<T, N, M> as "adaptive-kalman", 1, T, [N, M];
    [T: Scalar, const N: usize, const M: usize] for PublishedAdaptiveKalman<T, N, M>
        as "adaptive/publish", 1, T, [N, M];
}
