//! What stored estimators are. Raise the version of one that is stored otherwise than before.

use crate::Ahrs;
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar] for Ahrs<T> as "ahrs", 1, T, [];
}
