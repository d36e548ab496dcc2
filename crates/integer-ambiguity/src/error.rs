use core::fmt;

/// Reason why no integers were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// There are no ambiguities, or more than there is room for.
    WrongNumber,
    /// A number is not finite, or an ambiguity exceeds 10¹⁵, where doubles have no fractions.
    NotFinite,
    /// The covariance is not positive definite: a conditional variance of an ambiguity is not positive.
    NotPositive,
    /// Too many integer vectors are near the ambiguities, so the search was given up: they are not known well enough.
    Exhausted,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::WrongNumber => "no ambiguities, or more than there is room for",
            Self::NotFinite => "an ambiguity or its covariance is not finite",
            Self::NotPositive => "the covariance is not positive",
            Self::Exhausted => "too many integers are near the ambiguities",
        })
    }
}

impl core::error::Error for Error {}
