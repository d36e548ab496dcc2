//! Names and versions of stored estimators. Raise the version whenever the stored form changes.

use crate::Ahrs;
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar] for Ahrs<T> as "ahrs", 1, T, [];
}
