use core::fmt;

/// Why the application cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The satellite receiver's port failed.
    Gps,
    /// The radio's port failed.
    Radio,
    /// The telemetry's port failed.
    Telemetry,
    /// The source of randomness failed.
    Entropy,
    /// The constants of the site are invalid.
    Site(kestirim_user_locator::Error),
}

impl Error {
    pub(crate) fn channel(error: kestirim_air_to_ground::Error) -> Self {
        Self::Site(error.into())
    }

    pub(crate) fn filter(error: kestirim_particle_filter::Error) -> Self {
        Self::Site(error.into())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Gps => "the satellite receiver's port failed",
            Self::Radio => "the radio's port failed",
            Self::Telemetry => "telemetry cannot be sent",
            Self::Entropy => "the source of randomness failed",
            Self::Site(_) => "the site's numbers make no sense",
        })
    }
}

impl core::error::Error for Error {}
