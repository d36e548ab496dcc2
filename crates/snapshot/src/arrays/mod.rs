//! Arrays of any length and any element: serde itself supports up to 32 elements only, and no generic length.
//!
//! `#[serde(with = "kestirim_snapshot::arrays")]` is for `[E; N]`, [`rows`] for `[[E; N]; M]` and [`optional`] for
//! `Option<[E; N]>`. A number of elements other than the type's is an error of the format, never a panic.

pub mod optional;
pub mod rows;

use core::fmt;
use core::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use serde::ser::{Serialize, SerializeTuple, Serializer};

/// Writes the `N` elements, without their number.
///
/// # Errors
/// Those of the format.
pub fn serialize<S: Serializer, E: Serialize, const N: usize>(
    array: &[E; N],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut tuple = serializer.serialize_tuple(N)?;
    for element in array {
        tuple.serialize_element(element)?;
    }
    tuple.end()
}

/// Reads `N` elements.
///
/// # Errors
/// Those of the format, and if there are not `N` elements.
pub fn deserialize<'de, D: Deserializer<'de>, E: Deserialize<'de> + Copy, const N: usize>(
    deserializer: D,
) -> Result<[E; N], D::Error> {
    deserializer.deserialize_tuple(N, Elements(PhantomData))
}

struct Elements<E, const N: usize>(PhantomData<E>);

impl<'de, E: Deserialize<'de> + Copy, const N: usize> Visitor<'de> for Elements<E, N> {
    type Value = [E; N];

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "an array of {N} elements")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<[E; N], A::Error> {
        // An empty array has no first element to fill it with.
        if let Ok(none) = <[E; N]>::try_from([].as_slice()) {
            return Ok(none);
        }
        let first = sequence.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let mut array = [first; N];
        for (index, element) in array.iter_mut().enumerate().skip(1) {
            *element =
                sequence.next_element()?.ok_or_else(|| A::Error::invalid_length(index, &self))?;
        }
        Ok(array)
    }
}

/// A row of a matrix to be written.
struct RowOf<'a, E, const N: usize>(&'a [E; N]);

impl<E: Serialize, const N: usize> Serialize for RowOf<'_, E, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(self.0, serializer)
    }
}

/// A row of a matrix that was read.
#[derive(Clone, Copy)]
struct Row<E, const N: usize>([E; N]);

impl<'de, E: Deserialize<'de> + Copy, const N: usize> Deserialize<'de> for Row<E, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserialize(deserializer).map(Self)
    }
}

/// Reads an index less than `N`, for an array of `N` elements.
///
/// # Errors
/// Those of the format, and if the index is not less than `N`.
pub fn index<'de, D: Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<usize, D::Error> {
    let index = usize::deserialize(deserializer)?;
    if index < N { Ok(index) } else { Err(D::Error::custom("an index beyond its array")) }
}

/// Reads a count of at most `N`, of the elements in use of an array of `N`.
///
/// # Errors
/// Those of the format, and if the count is above `N`.
pub fn count<'de, D: Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<usize, D::Error> {
    let count = usize::deserialize(deserializer)?;
    if count <= N { Ok(count) } else { Err(D::Error::custom("a count beyond its array")) }
}
