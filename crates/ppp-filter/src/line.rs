//! The linearised code and phase of one satellite.

use crate::collected::collected;
use crate::states::{CLOCK, COMMON, GRADIENTS, WET};
use crate::{Config, Motion, SatelliteObservation, Slipped};
use kestirim_gnss_ppp::{Carriers, Constellation, Expected, Site, gradient_mapping};
use kestirim_scalar::Components;
use nalgebra::{SVector, Vector3};

/// A row of H: the states on which a phase depends, the ambiguity last.
pub(crate) type Row = heapless::Vec<(usize, f64), { COMMON + GRADIENTS.len() + 2 }>;

/// The variance of the constant, satellite-dependent code delays within a system, m²: for GLONASS those of the
/// receiver, which differ with the channel (inter-frequency biases, up to some metres), for BeiDou those of the
/// satellites.
pub(crate) const fn code_bias(carriers: Carriers) -> f64 {
    match carriers.constellation() {
        Constellation::Gps | Constellation::Galileo => 0.0,
        Constellation::Glonass | Constellation::BeiDou => 9.0,
    }
}

/// The phase variance of a system's satellites relative to that of GPS: orbits, clocks and antennas of GLONASS and
/// BeiDou are less well known (RTKLIB also scales the standard deviations of GLONASS by 1.5).
const fn phase_doubt(carriers: Carriers) -> f64 {
    match carriers.constellation() {
        Constellation::Gps | Constellation::Galileo => 1.0,
        Constellation::Glonass | Constellation::BeiDou => 1.5 * 1.5,
    }
}

/// The linearised code and phase of one satellite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) satellite: u8,
    /// The index of the satellite's ambiguity state.
    pub(crate) state: usize,
    /// The index of the state of its system's clock offset from the receiver's clock, unless the system defines that
    /// clock.
    pub(crate) offset: Option<usize>,
    pub(crate) slipped: Option<Slipped>,
    /// The mapping factors of the gradients, if they are estimated.
    pub(crate) gradients: Option<[f64; 2]>,
    /// The phases without jumps of the receiver's clock, cycles.
    phases: [f64; 2],
    pub(crate) expected: Expected,
    /// The code minus the expected code with no clock, no wet delay and no ambiguity, m.
    pub(crate) code: f64,
    pub(crate) phase: f64,
    pub(crate) code_variance: f64,
    pub(crate) phase_variance: f64,
    pub(crate) clock_variance: f64,
    /// The factor on the phase's own variance.
    pub(crate) phase_noise: f64,
}

impl Line {
    /// Creates a line whose `phases`, cycles, are those of the observation without jumps of the receiver's clock.
    pub(crate) fn new(
        observation: &SatelliteObservation<'_>,
        phases: [f64; 2],
        expected: Expected,
        state: usize,
        slipped: Option<Slipped>,
        config: &Config<impl Sized>,
    ) -> Self {
        let sine = expected.local.z;
        let clock = config.clock_variance(&observation.state);
        // The error of orbit and clock, common to code and phase.
        let told = observation.state.accuracy * observation.state.accuracy;
        let mut line = Self {
            satellite: observation.satellite,
            state,
            offset: None,
            slipped,
            gradients: None,
            phases,
            expected,
            code: 0.0,
            phase: 0.0,
            code_variance: config.code.variance(sine)
                + clock
                + told
                + code_bias(observation.carriers),
            phase_variance: phase_doubt(observation.carriers) * config.phase.variance(sine) + told,
            clock_variance: clock,
            phase_noise: 1.0,
        };
        line.compare(observation);
        line
    }

    /// Applies a satellite's learnt `noise` factor to the variances.
    pub(crate) fn learn(&mut self, noise: f64, motion: Motion) {
        self.clock_variance *= noise;
        if matches!(motion, Motion::Kinematic { .. }) {
            self.phase_noise = noise;
        }
    }

    /// Linearises the observations at another place.
    pub(crate) fn relinearise(&mut self, observation: &SatelliteObservation<'_>, site: &Site<'_>) {
        let wind_up = Some(self.expected.wind_up_cycles);
        let carriers = observation.carriers;
        if let Some(expected) =
            site.expect(&observation.state, carriers, observation.antenna.as_ref(), wind_up)
        {
            self.expected = expected;
            self.gradients = self.gradients.map(|_| gradient_mapping(&expected.local));
            self.compare(observation);
        }
    }

    fn compare(&mut self, observation: &SatelliteObservation<'_>) {
        let Expected { range, wind_up, .. } = self.expected;
        self.code = observation.carriers.ionosphere_free(observation.code) - range;
        self.phase = observation.carriers.ionosphere_free_phase(self.phases) - range - wind_up;
    }

    /// The row of the phase; the row of the code ends before the ambiguity.
    pub(crate) fn row(&self) -> Row {
        let [x, y, z] = *self.expected.sight.as_array();
        let wet = (WET, self.expected.wet_mapping);
        let common = [(0, -x), (1, -y), (2, -z), (CLOCK, 1.0), wet];
        let gradients = self.gradients.into_iter().flat_map(|them| GRADIENTS.into_iter().zip(them));
        let own = self.offset.map(|offset| (offset, 1.0)).into_iter().chain([(self.state, 1.0)]);
        collected(common.into_iter().chain(gradients).chain(own))
    }

    /// The innovations z − h(x⁻) of the code and of the phase, where the line is linearised at a position that differs
    /// by `offset` = x⁻ − x.
    pub(crate) fn innovations<const N: usize>(
        &self,
        mean: &SVector<f64, N>,
        offset: &Vector3<f64>,
    ) -> [f64; 2] {
        let of = |state: usize| mean.as_array().get(state).copied().unwrap_or(0.0);
        let mut common =
            of(CLOCK) + self.offset.map_or(0.0, of) + self.expected.wet_mapping * of(WET)
                - self.expected.sight.dot(offset);
        for (state, mapping) in GRADIENTS.into_iter().zip(self.gradients.unwrap_or_default()) {
            common += mapping * of(state);
        }
        [self.code - common, self.phase - common - of(self.state)]
    }
}
