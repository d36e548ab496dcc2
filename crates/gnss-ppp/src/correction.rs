/// A correction of the observation model beyond geometry and clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Correction {
    /// The relativistic effect of the orbit's eccentricity on the satellite's clock: up to 14 m.
    Relativity,
    /// The signal's delay in the Earth's gravity: 2 cm, nearly the same for all satellites.
    Shapiro,
    /// The Earth's rotation during the signal's flight: up to 40 m.
    Sagnac,
    /// The hydrostatic troposphere: 2.3 m at the zenith.
    Troposphere,
    /// The tide of the solid Earth: up to 40 cm.
    SolidTide,
    /// Loading by the ocean tides: up to 10 cm near the coast.
    OceanLoading,
    /// The phase wind-up by relative rotation of the antennas: up to a cycle.
    WindUp,
    /// The phase centre of the satellite's antenna: 1 to 3 m.
    SatelliteAntenna,
    /// The phase centre of the receiver's antenna: 5 to 15 cm.
    ReceiverAntenna,
    /// The pole tide: up to 25 mm.
    PoleTide,
}

impl Correction {
    /// All corrections.
    pub const ALL: [Self; 10] = [
        Self::Relativity,
        Self::Shapiro,
        Self::Sagnac,
        Self::Troposphere,
        Self::SolidTide,
        Self::OceanLoading,
        Self::WindUp,
        Self::SatelliteAntenna,
        Self::ReceiverAntenna,
        Self::PoleTide,
    ];
}

/// The set of corrections that are applied: all, unless one is left out to measure its effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Corrections {
    left_out: u16,
}

impl Corrections {
    /// All corrections.
    pub const ALL: Self = Self { left_out: 0 };

    /// These corrections without one of them.
    pub const fn without(self, correction: Correction) -> Self {
        Self { left_out: self.left_out | 1 << correction as u16 }
    }

    /// Whether a correction is applied.
    pub const fn has(self, correction: Correction) -> bool {
        self.left_out & (1 << correction as u16) == 0
    }
}

impl Default for Corrections {
    fn default() -> Self {
        Self::ALL
    }
}
