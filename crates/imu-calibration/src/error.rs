use core::fmt;

/// Reason for which there is no calibration, or a sample was refused. Nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// A number is NaN, infinite or on a rail of fixed point.
    NotFinite,
    /// A gravity, a noise, a radius or a scale that must be positive is not.
    NotPositive,
    /// There is no place for another pose, or a sum for another sample.
    Full,
    /// A pose without samples, or one in which nothing shows where up is.
    Empty,
    /// Fewer poses, turns or samples than unknowns.
    TooFew {
        /// How many there are.
        found: u16,
        /// How many it takes.
        needed: u16,
    },
    /// There are enough, but they are too much alike: what is asked for cannot be told from them.
    NotObservable,
    /// No calibration of a sensor that works explains what was measured.
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
