use core::fmt;

/// The reason why there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// A number is NaN or infinite.
    NotFinite,
    /// A mass, an inertia, a size, a density or a speed is not positive.
    NotPositive,
    /// E, or the inertia matrix, has no inverse.
    Singular,
    /// Newton's method finds no steady flight.
    NotConverged,
    /// Steady flight would require a throttle below 0 or above 1.
    BeyondThrottle,
    /// Steady flight would require an angle of attack beyond the wing's stall.
    BeyondStall,
    /// A climb angle is not between −π/2 and π/2.
    BeyondVertical,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a number is not finite",
            Self::NotPositive => "a mass, inertia, size, density or speed is not above zero",
            Self::Singular => "a matrix has no inverse",
            Self::NotConverged => "no steady flight was found",
            Self::BeyondThrottle => "no throttle from 0 to 1 holds this flight",
            Self::BeyondStall => "the wing is stalled at the angle of attack that it takes",
            Self::BeyondVertical => "a climb angle is not between -π/2 and π/2 rad",
        })
    }
}

impl core::error::Error for Error {}
