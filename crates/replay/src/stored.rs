//! Storing trackers, so that they can continue elsewhere.

use kestirim_scalar::Scalar;
#[cfg(feature = "snapshot")]
use kestirim_snapshot::Layout;
#[cfg(feature = "snapshot")]
use serde::{Serialize, de::DeserializeOwned};

/// A scalar in which trackers can be stored.
#[cfg(feature = "snapshot")]
pub trait Number: Scalar + Serialize + DeserializeOwned {}
/// A scalar; with the feature `snapshot`, one in which trackers can be stored.
#[cfg(not(feature = "snapshot"))]
pub trait Number: Scalar {}

#[cfg(feature = "snapshot")]
impl<T: Scalar + Serialize + DeserializeOwned> Number for T {}
#[cfg(not(feature = "snapshot"))]
impl<T: Scalar> Number for T {}

/// An estimator that can be stored.
#[cfg(feature = "snapshot")]
pub trait Stored: Layout + Serialize + DeserializeOwned {
    /// The snapshot of everything that it needs to continue elsewhere.
    fn stored(&self) -> Option<Vec<u8>> {
        let mut buffer = vec![0; kestirim_snapshot::size(self).ok()?];
        kestirim_snapshot::store(self, &mut buffer).ok()?;
        Some(buffer)
    }

    /// Restores an estimator; `None` if these bytes are not a snapshot of this type.
    fn restored(bytes: &[u8]) -> Option<Self> {
        kestirim_snapshot::load(bytes).ok()
    }
}

/// Any estimator; with the feature `snapshot`, one that can be stored.
#[cfg(not(feature = "snapshot"))]
pub trait Stored: Sized {
    /// Always `None` without the feature `snapshot`.
    fn stored(&self) -> Option<Vec<u8>> {
        None
    }

    /// Always `None` without the feature `snapshot`.
    fn restored(_: &[u8]) -> Option<Self> {
        None
    }
}

#[cfg(feature = "snapshot")]
impl<E: Layout + Serialize + DeserializeOwned> Stored for E {}
#[cfg(not(feature = "snapshot"))]
impl<E> Stored for E {}

/// Writes numbers, followed by a snapshot.
pub(crate) fn behind<const N: usize>(numbers: [u64; N], snapshot: &[u8]) -> Vec<u8> {
    numbers.into_iter().flat_map(u64::to_le_bytes).chain(snapshot.iter().copied()).collect()
}

/// Reads numbers and the snapshot that follows them.
pub(crate) fn read<const N: usize>(mut bytes: &[u8]) -> Option<([u64; N], &[u8])> {
    let mut numbers = [0; N];
    for number in &mut numbers {
        let (first, rest) = bytes.split_first_chunk()?;
        (*number, bytes) = (u64::from_le_bytes(*first), rest);
    }
    Some((numbers, bytes))
}
