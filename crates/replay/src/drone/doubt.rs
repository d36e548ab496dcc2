//! Doubts about a flight.

use kestirim_air_to_ground::Channel;

use super::among_buildings::FAR_OFF_DB;
use super::{Estimate, Misfit, Quantity, Stop, level_step};

/// A reason to doubt a flight, or what it was assumed to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Doubt {
    /// The levels step: another gain, antenna or transmitter.
    Step {
        /// The time of the step, s.
        t: f64,
        /// The size of the step, dB.
        by: f64,
    },
    /// The user moves but was assumed to stay: the distance between the places from the first and the last third of the
    /// flight, m.
    Moved(f64),
    /// All path losses are off by this much (dB), so that the transmitter is not the one assumed.
    Off(f64),
    /// The environment does not explain the measurements.
    Misfit(Misfit),
}

impl Doubt {
    /// All doubts about the measurements of an estimate; `channel` is that of the environment, if one is known, and
    /// `moved_m` the result of [`Search::moved`](super::Search::moved).
    pub fn all(
        stops: &[Stop],
        estimate: &Estimate,
        channel: Option<&Channel<f64>>,
        moved_m: Option<f64>,
    ) -> impl Iterator<Item = Self> {
        let stops = stops.get(estimate.first..=estimate.stop).unwrap_or(stops);
        let step = level_step(stops, estimate.place).map(|(t, by)| Self::Step { t, by });
        let misfit = channel.and_then(|it| Misfit::find(stops, estimate, it));
        // The level of an unknown transmitter may be anything.
        let is_far = estimate.level_db.is_none() && estimate.off_db.abs() > FAR_OFF_DB;
        let off = is_far.then_some(Self::Off(estimate.off_db));
        [step, moved_m.map(Self::Moved), off, misfit.map(Self::Misfit)].into_iter().flatten()
    }

    /// The doubt in a sentence, with the name of the environment.
    pub fn sentence(&self, environment: &str, quantity: Quantity) -> String {
        match self {
            Self::Step { t, by } => format!(
                "the levels step by {by:+.0} dB at {t:.0} s: another gain or antenna, or another transmitter"
            ),
            Self::Moved(apart) => format!(
                "the first and the last third of the flight place the user {apart:.0} m apart: one who moves needs --window"
            ),
            Self::Off(by) => format!(
                "all path losses are {by:+.0} dB off, as far as is thought possible: the transmitter is weaker or stronger than supposed, or the antennas are; \
                 levels (rssi_db) suppose nothing"
            ),
            Self::Misfit(misfit) => misfit.sentence(environment, quantity),
        }
    }
}
