//! Serialisation of arrays of any length; serde itself has it up to 32 only.

use serde::{Serialize, Serializer};

pub(crate) fn array<S: Serializer, T: Serialize, const D: usize>(
    array: &[T; D],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(array)
}

pub(crate) fn matrix<S: Serializer, T: Serialize, const D: usize>(
    matrix: &[[T; D]; D],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(matrix.each_ref().map(<[T; D]>::as_slice))
}
