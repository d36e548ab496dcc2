#![doc = include_str!("../README.md")]
#![no_std]

pub mod arrays;
mod error;
mod finite;
mod header;
mod layout;
mod name;

pub use error::{Difference, Error};
pub use header::Header;
pub use layout::{Layout, Number};
pub use name::Name;

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The checksum of telemetry and ZIP, without a table of 1 kB.
const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);
const CHECKSUM: usize = size_of::<u32>();

/// Bytes of a snapshot in addition to the state itself.
pub const OVERHEAD: usize = Header::SIZE + CHECKSUM;

/// Stores an estimator in the buffer, and returns the bytes that hold it.
///
/// # Errors
/// [`Error::BufferTooShort`].
pub fn store<'a, E: Layout + Serialize>(
    estimator: &E,
    buffer: &'a mut [u8],
) -> Result<&'a [u8], Error> {
    let state = buffer
        .get_mut(Header::SIZE..)
        .and_then(|rest| rest.len().checked_sub(CHECKSUM).and_then(|room| rest.get_mut(..room)))
        .ok_or(Error::BufferTooShort)?;
    let length = postcard::to_slice(estimator, state).map_err(|_| Error::BufferTooShort)?.len();
    let header = Header::of::<E>(u32::try_from(length).map_err(|_| Error::BufferTooShort)?);
    let end = Header::SIZE + length;
    header.write(buffer).ok_or(Error::BufferTooShort)?;
    let checksum = CRC.checksum(buffer.get(..end).ok_or(Error::BufferTooShort)?);
    let place = buffer.get_mut(end..end + CHECKSUM).ok_or(Error::BufferTooShort)?;
    place.copy_from_slice(&checksum.to_le_bytes());
    buffer.get(..end + CHECKSUM).ok_or(Error::BufferTooShort)
}

/// The number of bytes that [`store`] would write now; it varies with what the estimator holds.
///
/// # Errors
/// None for the estimators of kestirim.
pub fn size<E: Layout + Serialize>(estimator: &E) -> Result<usize, Error> {
    let state = postcard::serialize_with_flavor(estimator, postcard::ser_flavors::Size::default());
    state.map(|length| length + OVERHEAD).map_err(|_| Error::BufferTooShort)
}

/// The header of a snapshot, which says what it holds; nothing else is examined.
///
/// # Errors
/// [`Error::TooShort`] and [`Error::NoSnapshot`].
pub fn header(bytes: &[u8]) -> Result<Header, Error> {
    Header::read(bytes)
}

/// Loads an estimator; bytes after the snapshot (the rest of a page) are ignored.
///
/// # Errors
/// [`Error::TooShort`], [`Error::NoSnapshot`] and [`Error::Torn`] if the bytes are not a complete snapshot;
/// [`Error::Foreign`] if it is of another estimator, layout, number format or size, naming both;
/// [`Error::Invalid`] and [`Error::NotFinite`] if it holds values that the estimator cannot have.
pub fn load<E: Layout + DeserializeOwned + Serialize>(bytes: &[u8]) -> Result<E, Error> {
    let found = Header::read(bytes)?;
    let end =
        usize::try_from(found.length).ok().and_then(|length| length.checked_add(Header::SIZE));
    let end = end.ok_or(Error::TooShort)?;
    let (content, checksum) =
        (bytes.get(..end), bytes.get(end..).and_then(|rest| rest.first_chunk::<CHECKSUM>()));
    let (Some(content), Some(checksum)) = (content, checksum) else { return Err(Error::TooShort) };
    if CRC.checksum(content) != u32::from_le_bytes(*checksum) {
        return Err(Error::Torn);
    }
    let expected = Header::of::<E>(found.length);
    if found != expected {
        return Err(Error::Foreign(Difference { found, expected }));
    }
    let state = content.get(Header::SIZE..).unwrap_or_default();
    let (estimator, rest) = postcard::take_from_bytes::<E>(state).map_err(|_| Error::Invalid)?;
    if !rest.is_empty() {
        return Err(Error::Invalid);
    }
    if !finite::is_finite(&estimator, !E::IS_FINITE) {
        return Err(Error::NotFinite);
    }
    Ok(estimator)
}
