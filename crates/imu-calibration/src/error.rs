use core::fmt;

/// The reason why there is no calibration, or why a sample was refused. Nothing is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// A number is NaN, infinite or at the limit of a fixed-point type.
    NotFinite,
    /// A gravity, a noise, a radius or a scale is not positive.
    NotPositive,
    /// There is no room for another pose, or the count of samples is exhausted.
    Full,
    /// A pose has no samples, or no direction of gravity.
    Empty,
    /// There are fewer poses, turns or samples than unknowns.
    TooFew {
        /// The number available.
        found: u16,
        /// The number required.
        needed: u16,
    },
    /// There are enough, but they are too similar to determine the unknowns.
    NotObservable,
    /// No calibration of a working sensor explains the measurements.
    Inconsistent,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { found, needed } => {
                return write!(formatter, "expected at least {needed}, found {found}");
            }
            Self::NotFinite => "a number is not finite",
            Self::NotPositive => "a number that must be positive is not",
            Self::Full => "there is no place for more",
            Self::Empty => "there is nothing to begin with",
            Self::NotObservable => "what was measured is too much alike to tell the calibration",
            Self::Inconsistent => "no calibration explains what was measured",
        }
        .fmt(formatter)
    }
}

impl core::error::Error for Error {}
