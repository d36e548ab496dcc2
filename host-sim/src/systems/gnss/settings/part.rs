//! Parts of the observation model.

use clap::ValueEnum;
use kestirim_gnss_ppp::Correction;

/// A part of the observation model that can be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Part {
    /// The satellite's clock on its eccentric orbit
    Relativity,
    /// The delay in the Earth's gravity
    Shapiro,
    /// The Earth's rotation while the signal travels
    Sagnac,
    /// The hydrostatic troposphere
    Troposphere,
    /// The tide of the solid Earth
    SolidTide,
    /// The load of the oceans' tides
    OceanLoading,
    /// The turning of the antennas against each other
    WindUp,
    /// The phase centre of the satellite's antenna
    SatelliteAntenna,
    /// The phase centre of the receiver's antenna
    ReceiverAntenna,
    /// The tide of the pole
    PoleTide,
}

impl From<Part> for Correction {
    fn from(part: Part) -> Self {
        match part {
            Part::Relativity => Self::Relativity,
            Part::Shapiro => Self::Shapiro,
            Part::Sagnac => Self::Sagnac,
            Part::Troposphere => Self::Troposphere,
            Part::SolidTide => Self::SolidTide,
            Part::OceanLoading => Self::OceanLoading,
            Part::WindUp => Self::WindUp,
            Part::SatelliteAntenna => Self::SatelliteAntenna,
            Part::ReceiverAntenna => Self::ReceiverAntenna,
            Part::PoleTide => Self::PoleTide,
        }
    }
}
