//! How the filter sees its sensors.

use kestirim_gnss_ppp::SlipLimits;

/// Whether the receiver moves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Motion {
    /// It stands still.
    Static,
    /// It moves: each coordinate walks randomly.
    Kinematic {
        /// Variance added per second to each coordinate, m²/s.
        process_noise: f64,
    },
}

/// Standard deviation of an ionosphere-free observation: σ² = a² + b²/sin²E at the elevation E.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Deviation {
    /// a, m.
    pub constant: f64,
    /// b, m.
    pub elevation: f64,
}

impl Deviation {
    /// σ² at an elevation of which the sine is given, m².
    pub(crate) fn variance(&self, sine: f64) -> f64 {
        let slanted = self.elevation * libm::sqrt(1.0 - sine * sine);
        self.constant * self.constant + slanted * slanted
    }
}

/// All settings of the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// Whether the receiver moves.
    pub motion: Motion,
    /// Lowest elevation of a satellite, rad.
    pub elevation_mask: f64,
    /// Noise of the ionosphere-free phase.
    pub phase: Deviation,
    /// Noise of the ionosphere-free code.
    pub code: Deviation,
    /// How fast satellite clocks wander between the samples of their product: variance per second,
    /// m²/s. Between two samples the error is a random walk tied at both ends.
    pub clock_walk: f64,
    /// Standard deviation of the first wet zenith delay, m.
    pub wet_delay: f64,
    /// Variance per second by which the wet zenith delay walks, m²/s.
    pub wet_delay_walk: f64,
    /// From when on a jump of the combinations is a slip.
    pub slips: SlipLimits,
    pub k0: f64, pub k1: f64, pub patience: u8,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            motion: Motion::Static,
            elevation_mask: 8_f64.to_radians(),
            phase: Deviation { constant: 0.009, elevation: 0.009 },
            code: Deviation { constant: 0.9, elevation: 0.9 },
            clock_walk: 0.0,
            wet_delay: 0.3,
            wet_delay_walk: 1e-8,
            slips: SlipLimits::default(), k0: 0.0, k1: 6.0, patience: 3,
        }
    }
}
