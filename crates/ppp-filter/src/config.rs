//! Settings of the filter.

use crate::Estimator;
use kestirim_gnss_ppp::{SatelliteState, SlipLimits};
use kestirim_robust_kalman::Robust;

/// The motion model of the receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Motion {
    /// A receiver at rest.
    Static,
    /// A moving receiver, whose coordinates are random walks.
    Kinematic {
        /// Variance added per second to each coordinate, m²/s.
        process_noise: f64,
    },
}

/// The standard deviation of an ionosphere-free observation: σ² = a² + b²·cos²E at the elevation E (the published
/// weighting). The combination is three times as noisy as one carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Deviation {
    /// a, m.
    pub zenith: f64,
    /// b, m.
    pub slant: f64,
}

impl Deviation {
    /// The variance σ² at an elevation given by its sine, m².
    pub(crate) fn variance(&self, sine: f64) -> f64 {
        self.zenith * self.zenith + self.slant * self.slant * (1.0 - sine * sine)
    }

    /// The variance σ² of a single epoch's solution, in which nothing averages the errors of low satellites, m²: (a² +
    /// b²·cot²E)/2, which fits the codes of five geodetic receivers, 0.3 to 0.8 m/sin E.
    pub(crate) fn variance_of_one_epoch(&self, sine: f64) -> f64 {
        let cotangent_squared = 1.0 / (sine * sine) - 1.0;
        0.5 * (self.zenith * self.zenith + self.slant * self.slant * cotangent_squared)
    }
}

/// All settings of the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config<R = Robust<f64>> {
    /// The motion model of the receiver. The default `estimator` is made for it: change both together.
    pub motion: Motion,
    /// The elevation mask, rad: lower satellites are not used.
    pub elevation_mask: f64,
    /// The noise of the ionosphere-free phase.
    pub phase: Deviation,
    /// The noise of the ionosphere-free code.
    pub code: Deviation,
    /// Random walk of satellite clocks between the samples of their product: variance per second, m²/s. Between two
    /// samples the error is a random walk tied down at both ends.
    pub clock_walk: f64,
    /// The initial standard deviation of the wet zenith delay, m.
    pub wet_delay: f64,
    /// Random walk of the wet zenith delay: variance per second, m²/s.
    pub wet_delay_walk: f64,
    /// The standard deviation of the troposphere's horizontal gradients to the north and to the east, m: their initial
    /// value, and their change in a day.
    ///
    /// A millimetre is 3 cm at 10° of elevation. With zero they are not estimated, nor where the first epoch's clocks
    /// are interpolated over more than five minutes, which hides them. They take the room of two satellites.
    pub gradient: f64,
    /// The thresholds of cycle slip detection.
    pub slips: SlipLimits,
    /// The correlation time of an observation's errors (multipath, troposphere, orbits), s: the reported covariances
    /// count what is observed within it as one observation.
    pub correlation_time: f64,
    /// How observations that do not fit are treated.
    pub estimator: Estimator<R>,
}

/// Whether a setting is finite and not negative.
#[inline(never)] // Asked of each setting.
fn is_deviation(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}

impl<R> Config<R> {
    /// Whether all settings are valid.
    pub(crate) fn is_valid(&self) -> bool {
        let motion = match self.motion {
            Motion::Static => 0.0,
            Motion::Kinematic { process_noise } => process_noise,
        };
        let Deviation { zenith: phase, slant: phase_slant } = self.phase;
        let Deviation { zenith: code, slant: code_slant } = self.code;
        let settings = [
            phase,
            code,
            self.wet_delay,
            motion,
            phase_slant,
            code_slant,
            self.clock_walk,
            self.wet_delay_walk,
            self.gradient,
            self.correlation_time,
        ];
        self.elevation_mask.is_finite()
            && settings.iter().all(|&value| is_deviation(value))
            && settings.iter().take(3).all(|&value| value > 0.0)
    }

    /// The variance that the interpolation of a satellite's clock adds to an observation, m².
    pub(crate) fn clock_variance(&self, state: &SatelliteState) -> f64 {
        let SatelliteState { clock_interval: interval, clock_distance: distance, .. } = *state;
        if interval > 0.0 {
            self.clock_walk * distance * (interval - distance) / interval
        } else {
            0.0
        }
    }

    /// The settings with another treatment of observations that do not fit.
    #[must_use]
    pub fn with_estimator<S>(self, estimator: Estimator<S>) -> Config<S> {
        let Self { motion, elevation_mask, phase, code, clock_walk, wet_delay, .. } = self;
        let Self { wet_delay_walk, gradient, slips, correlation_time, .. } = self;
        Config {
            motion,
            elevation_mask,
            phase,
            code,
            clock_walk,
            wet_delay,
            wet_delay_walk,
            gradient,
            slips,
            correlation_time,
            estimator,
        }
    }
}

impl Config {
    /// The settings for broadcast ephemerides, each weighted by its own accuracy ([`SatelliteState::accuracy`]).
    ///
    /// The error of an ephemeris stays the same for as long as the ephemeris is in use, up to two hours. Gradients are
    /// negligible beside it.
    pub fn broadcast(motion: Motion) -> Self {
        Self { correlation_time: 7_200.0, gradient: 0.0, ..Self::new(motion) }
    }

    /// The settings for geodetic receivers with final products of the IGS, with which our results are made.
    ///
    /// They are the published ones (Table 1), except for the estimator, and for slip limits that a code outlier cannot
    /// imitate.
    pub fn new(motion: Motion) -> Self {
        Self {
            motion,
            elevation_mask: 8_f64.to_radians(),
            phase: Deviation { zenith: 0.009, slant: 0.009 },
            code: Deviation { zenith: 0.9, slant: 0.9 },
            clock_walk: 1e-5,
            wet_delay: 0.3,
            wet_delay_walk: 1e-8,
            gradient: 5e-4,
            slips: SlipLimits::default(),
            correlation_time: 600.0,
            estimator: Estimator::guarded(motion),
        }
    }
}
