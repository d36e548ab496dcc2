//! Names and versions of stored estimators. Raise the version whenever the stored form changes.

use crate::Gaussian;
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar, const N: usize] for Gaussian<T, N> as "kalman", 1, T, [N];
}
