use core::fmt;

/// The reason why an epoch has no solution. The filter is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// Fewer than four satellites have complete observations, orbits and clocks above the
    /// elevation mask.
    TooFewSatellites,
    /// The geometry of the satellites is such that the codes determine no position.
    PoorGeometry,
    /// The epoch is not later than the preceding one.
    TimeNotAdvancing,
    /// The iteration of the position does not converge: the observations contradict each other.
    Contradictory,
    /// A setting is negative or not finite: see [`Config`](crate::Config) and
    /// [`Robust`](kestirim_robust_kalman::Robust).
    InvalidConfiguration,
    /// A number is not finite.
    NotFinite,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::TooFewSatellites => "fewer than four usable satellites",
            Self::PoorGeometry => "the satellites' geometry fixes no position",
            Self::TimeNotAdvancing => "the epoch is not later than the one before",
            Self::Contradictory => "the measurements contradict each other",
            Self::InvalidConfiguration => "the settings are not valid",
            Self::NotFinite => "a number is not finite",
        })
    }
}

impl core::error::Error for Error {}

/// Converts errors of the update: rows and blocks are right by construction, so only numbers can be wrong.
impl From<kestirim_kalman::Error> for Error {
    fn from(_: kestirim_kalman::Error) -> Self {
        Self::NotFinite
    }
}

impl From<kestirim_robust_kalman::Error> for Error {
    fn from(error: kestirim_robust_kalman::Error) -> Self {
        match error {
            kestirim_robust_kalman::Error::InvalidConfiguration => Self::InvalidConfiguration,
            _ => Self::NotFinite,
        }
    }
}
