use core::fmt;

/// The reason why a model has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// A number is NaN, infinite or on a rail of fixed point.
    NotFinite,
    /// A height, a wavelength, a standard deviation or a speed is not positive.
    NotPositive,
    /// The path loss is beyond ±300 dB, which no radio measures.
    ImplausibleLoss,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a number is not finite",
            Self::NotPositive => "a number that must be positive is not",
            Self::ImplausibleLoss => "no radio measures this path loss",
        })
    }
}

impl core::error::Error for Error {}
