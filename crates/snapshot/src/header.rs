use core::fmt;

use crate::{Error, Layout, Name, Number};

/// The header of a snapshot, which says what it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Header {
    /// Name of the estimator.
    pub name: Name,
    /// Version of the estimator's layout.
    pub version: u16,
    /// Number format that the estimator computes in.
    pub number: Number,
    /// Sizes of the estimator, such as the number of its states.
    pub sizes: [u32; 4],
    /// Length of the state, in bytes.
    pub length: u32,
}

/// First bytes of each snapshot; an erased page is all ones or all zeros.
const MAGIC: [u8; 2] = *b"kS";
/// Version of the header itself and of the encoding of the state.
const ENVELOPE: u8 = 1;

impl Header {
    pub(crate) const SIZE: usize = 42;

    pub(crate) fn of<E: Layout>(length: u32) -> Self {
        Self {
            name: const { Name::new(E::NAME) },
            version: E::VERSION,
            number: E::number(),
            sizes: E::sizes(),
            length,
        }
    }

    /// Writes the header at the beginning of the buffer; `None` if there is no room.
    pub(crate) fn write(&self, buffer: &mut [u8]) -> Option<()> {
        let (start, rest) = buffer.split_first_chunk_mut::<4>()?;
        let (name, rest) = rest.split_first_chunk_mut::<{ Name::SIZE }>()?;
        let (version, rest) = rest.split_first_chunk_mut::<2>()?;
        let (sizes, rest) = rest.split_first_chunk_mut::<16>()?;
        let length = rest.first_chunk_mut::<4>()?;
        let [first, second] = MAGIC;
        *start = [first, second, ENVELOPE, self.number.to_byte()];
        *name = self.name.to_bytes();
        *version = self.version.to_le_bytes();
        for (bytes, size) in sizes.chunks_exact_mut(4).zip(self.sizes) {
            bytes.copy_from_slice(&size.to_le_bytes());
        }
        *length = self.length.to_le_bytes();
        Some(())
    }

    pub(crate) fn read(bytes: &[u8]) -> Result<Self, Error> {
        let (start, rest) = bytes.split_first_chunk::<4>().ok_or(Error::TooShort)?;
        let (name, rest) = rest.split_first_chunk::<{ Name::SIZE }>().ok_or(Error::TooShort)?;
        let (version, rest) = rest.split_first_chunk::<2>().ok_or(Error::TooShort)?;
        let (sizes, rest) = rest.split_first_chunk::<16>().ok_or(Error::TooShort)?;
        let length = rest.first_chunk::<4>().ok_or(Error::TooShort)?;
        let &[m0, m1, envelope, number] = start;
        let mut stored = sizes.chunks_exact(4).map(|bytes| {
            bytes.first_chunk().map_or(0, |bytes: &[u8; 4]| u32::from_le_bytes(*bytes))
        });
        if [m0, m1] != MAGIC || envelope != ENVELOPE {
            return Err(Error::NoSnapshot);
        }
        Ok(Self {
            name: Name::from_bytes(*name),
            version: u16::from_le_bytes(*version),
            number: Number::from_byte(number),
            sizes: [0; 4].map(|_| stored.next().unwrap_or(0)),
            length: u32::from_le_bytes(*length),
        })
    }
}

impl fmt::Display for Header {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, version, number, sizes, .. } = self;
        write!(formatter, "{name} layout {version} in {number}, sizes {sizes:?}")
    }
}
