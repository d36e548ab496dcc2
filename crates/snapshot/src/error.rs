use core::fmt;

use crate::Header;

/// The snapshot that was found, and the one that was expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Difference {
    /// Header of the snapshot that was found.
    pub found: Header,
    /// Header of the snapshot that was to be loaded.
    pub expected: Header,
}

/// Reason why a snapshot was not stored or loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The buffer is shorter than the snapshot.
    BufferTooShort,
    /// There are fewer bytes than the snapshot should have.
    TooShort,
    /// The bytes do not begin like a snapshot of this version of the crate.
    NoSnapshot,
    /// The checksum does not match: the bytes were changed, or not all of them were written.
    Torn,
    /// The snapshot is of another estimator, layout, number format or size.
    Foreign(Difference),
    /// The snapshot holds values that the estimator cannot have, such as an index beyond its array
    /// or a negative variance.
    Invalid,
    /// The snapshot holds a float that is NaN or infinite.
    NotFinite,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BufferTooShort => formatter.write_str("the buffer is too short for the snapshot"),
            Self::TooShort => formatter.write_str("the snapshot has too few bytes"),
            Self::NoSnapshot => formatter.write_str("these bytes are no snapshot"),
            Self::Torn => {
                formatter.write_str("the snapshot's checksum is wrong: it was not written whole")
            }
            Self::Foreign(Difference { found, expected }) => {
                write!(formatter, "a snapshot of {found}, expected {expected}")
            }
            Self::Invalid => {
                formatter.write_str("the snapshot holds what the estimator cannot be in")
            }
            Self::NotFinite => {
                formatter.write_str("the snapshot holds a number that is not finite")
            }
        }
    }
}

impl core::error::Error for Error {}
