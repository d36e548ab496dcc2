//! What stored estimators are. Raise the version of one that is stored otherwise than before.

use crate::Gaussian;
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar, const N: usize] for Gaussian<T, N> as "kalman", 1, T, [N];
}
