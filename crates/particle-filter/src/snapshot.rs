//! Names and versions of stored estimators. Raise the version whenever the stored form changes.

use crate::{Particles, PointMass};
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar, const D: usize, const N: usize] for Particles<T, D, N> as "particles", 1, T, [D, N], infinite;
    [T: Scalar, const D: usize, const N: usize] for PointMass<T, D, N> as "point-mass", 1, T, [D, N], infinite;
}
