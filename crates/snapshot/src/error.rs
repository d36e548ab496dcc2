use core::fmt;

use crate::Header;

/// What was found, and what was to be loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Difference {
    /// What the snapshot holds.
    pub found: Header,
    /// What was asked for.
    pub expected: Header,
}

/// Why a snapshot was not stored or loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The buffer has less room than the snapshot needs.
    BufferTooShort,
    /// There are fewer bytes than the snapshot has.
    TooShort,
    /// The bytes do not begin as a snapshot of this version of the crate.
    NoSnapshot,
    /// The checksum is another: the bytes were changed, or not all of them were written.
    Torn,
    /// A snapshot of another estimator, layout, number format or size.
    Foreign(Difference),
    /// Values that the estimator cannot have: an index beyond its array, a variance that is negative.
    Invalid,
    /// A number that is none.
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
