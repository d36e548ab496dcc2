//! Snapshot layouts of the estimators. Raise the version of an estimator whose stored form changes.

use crate::{Channel, Contaminated, FreeSpace, OpenGround};
use kestirim_scalar::Scalar;
use kestirim_snapshot::layout;

layout! {
    [T: Scalar] for Channel<T> as "channel/urban", 1, T, [];
    [T: Scalar] for Contaminated<T> as "channel/outliers", 1, T, [];
    [T: Scalar] for FreeSpace<T> as "channel/free", 1, T, [];
    [T: Scalar] for OpenGround<T> as "channel/open", 1, T, [];
}
