//! Arrays of arrays: `[[E; N]; M]`.

use super::{Deserialize, Deserializer, Row, RowOf, Serialize, SerializeTuple, Serializer};

/// Writes the elements, row by row.
///
/// # Errors
/// Those of the format.
pub fn serialize<S: Serializer, E: Serialize, const N: usize, const M: usize>(
    rows: &[[E; N]; M],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut tuple = serializer.serialize_tuple(M)?;
    for row in rows {
        tuple.serialize_element(&RowOf(row))?;
    }
    tuple.end()
}

/// Reads the elements, row by row.
///
/// # Errors
/// Those of the format, and if there are not `M` rows of `N`.
pub fn deserialize<'de, D, E, const N: usize, const M: usize>(
    deserializer: D,
) -> Result<[[E; N]; M], D::Error>
where
    D: Deserializer<'de>,
    E: Deserialize<'de> + Copy,
{
    super::deserialize::<D, Row<E, N>, M>(deserializer).map(|rows| rows.map(|row| row.0))
}
