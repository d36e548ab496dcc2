use core::fmt;

/// The reason why a measurement or an area was refused. The locator is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// The channel refused the measurement: not finite, an implausible loss, or a height that is not positive.
    Channel(kestirim_air_to_ground::Error),
    /// The filter refused the measurement: nothing in the region explains it.
    Filter(kestirim_particle_filter::Error),
    /// A corner of an area is not finite.
    NotFinite,
    /// An area has more corners than its capacity.
    TooManyCorners,
    /// The corners of an area enclose nothing.
    NoArea,
}

impl From<kestirim_air_to_ground::Error> for Error {
    fn from(error: kestirim_air_to_ground::Error) -> Self {
        Self::Channel(error)
    }
}

impl From<kestirim_particle_filter::Error> for Error {
    fn from(error: kestirim_particle_filter::Error) -> Self {
        Self::Filter(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Channel(error) => error.fmt(formatter),
            Self::Filter(error) => error.fmt(formatter),
            Self::NotFinite => formatter.write_str("a corner of the area is not finite"),
            Self::TooManyCorners => formatter.write_str("the area has too many corners"),
            Self::NoArea => formatter.write_str("the corners of the area enclose nothing"),
        }
    }
}

impl core::error::Error for Error {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Channel(error) => Some(error),
            Self::Filter(error) => Some(error),
            Self::NotFinite | Self::TooManyCorners | Self::NoArea => None,
        }
    }
}
