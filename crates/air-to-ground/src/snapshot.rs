//! What stored estimators are. Raise the version of one that is stored otherwise than before.

use crate::{Channel, Contaminated, FreeSpace, OpenGround};
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar] for Channel<T> as "channel/urban", 1, T, [];
    [T: Scalar] for Contaminated<T> as "channel/outliers", 1, T, [];
    [T: Scalar] for FreeSpace<T> as "channel/free", 1, T, [];
    [T: Scalar] for OpenGround<T> as "channel/open", 1, T, [];
}
