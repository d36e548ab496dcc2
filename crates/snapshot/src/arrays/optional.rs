//! Arrays that may be missing: `Option<[E; N]>`.

use super::{Deserialize, Deserializer, Row, RowOf, Serialize, Serializer};

/// Writes the elements, if the array is present.
///
/// # Errors
/// Those of the format.
pub fn serialize<S: Serializer, E: Serialize, const N: usize>(
    array: &Option<[E; N]>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    array.as_ref().map(RowOf).serialize(serializer)
}

/// Reads the elements, if the array is present.
///
/// # Errors
/// Those of the format, and if there are not `N` elements.
pub fn deserialize<'de, D: Deserializer<'de>, E: Deserialize<'de> + Copy, const N: usize>(
    deserializer: D,
) -> Result<Option<[E; N]>, D::Error> {
    Ok(Option::<Row<E, N>>::deserialize(deserializer)?.map(|row| row.0))
}
