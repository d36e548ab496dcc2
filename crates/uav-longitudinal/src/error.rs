use core::fmt;

/// Reason for which there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// A number is NaN or infinite.
    NotFinite,
    /// A mass, an inertia, a size, a density or a speed that must be above zero is not.
    NotPositive,
    /// E, or the inertia, has no inverse.
    Singular,
    /// Newton's method finds no steady flight.
    NotConverged,
    /// Steady flight would take a throttle below 0 or above 1.
    BeyondThrottle,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a number is not finite",
            Self::NotPositive => "a number that must be positive is not",
            Self::Singular => "a matrix has no inverse",
            Self::NotConverged => "no steady flight was found",
            Self::BeyondThrottle => "no throttle from 0 to 1 holds this flight",
        })
    }
}

impl core::error::Error for Error {}
