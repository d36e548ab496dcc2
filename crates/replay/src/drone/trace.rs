//! What was measured, and where the user is after each measurement.

use kestirim_air_to_ground::Rotor;

use super::{Estimate, Stop};
use crate::metrics::distance;

/// How far a synthetic drone flew.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Flown {
    /// Length of its path, m.
    pub path_m: f64,
    /// Sum of its climbs, m.
    pub climb_m: f64,
    /// How long it hovered, s.
    pub hover_s: f64,
}

impl Flown {
    /// Energy of the flight at a constant speed, J.
    ///
    /// # Panics
    /// The speed is not above zero.
    pub fn energy_j(&self, speed_kmh: f64) -> f64 {
        let rotor = Rotor::<f64>::base_station();
        let flying = rotor.energy(self.path_m, speed_kmh / 3.6, self.hover_s);
        flying.expect("a speed above zero") + rotor.weight * self.climb_m
    }
}

/// Another transmitter that was heard.
#[derive(Debug, Clone, PartialEq)]
pub struct Other {
    /// As the log names it.
    pub name: String,
    /// Where it is after the last measurement; none if no place explains them, and of fewer than three.
    pub estimate: Option<Estimate>,
    /// Where it really was then, if anybody knows.
    pub truth: Option<[f64; 2]>,
}

impl Other {
    /// Distance of the estimate from the truth, if anybody knows it, m.
    pub fn error_m(&self) -> Option<f64> {
        Some(distance(self.estimate.as_ref()?.place, self.truth?))
    }
}

/// What was measured, and where the user is after each measurement that some place explains.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Track {
    /// The measurements that are used.
    pub stops: Vec<Stop>,
    /// Where the user really was at each of them; empty if nobody knows.
    pub truth: Vec<[f64; 2]>,
    /// In the order of the measurements.
    pub estimates: Vec<Estimate>,
    /// What a reader should know.
    pub warnings: Vec<String>,
    /// How far apart (m) the first and the last third of the flight place a user who is taken for one who stays, if that is no
    /// chance.
    pub moved_m: Option<f64>,
    /// Of a synthetic drone.
    pub flown: Option<Flown>,
    /// Other transmitters that were heard on the same flight.
    pub others: Vec<Other>,
}

impl Track {
    /// The measurement of an estimate.
    pub fn stop(&self, estimate: &Estimate) -> Stop {
        self.stops[estimate.stop]
    }

    /// Where the user really was at an estimate, if anybody knows.
    pub fn user(&self, estimate: &Estimate) -> Option<[f64; 2]> {
        self.truth.get(estimate.stop).copied()
    }

    /// Distance of an estimate from the user, if anybody knows where they were, m.
    pub fn error_m(&self, estimate: &Estimate) -> Option<f64> {
        Some(distance(self.user(estimate)?, estimate.place))
    }

    /// Seconds since the first measurement at an estimate.
    pub fn seconds(&self, estimate: &Estimate) -> f64 {
        self.stop(estimate).t - self.stops.first().map_or(0.0, |stop| stop.t)
    }

    /// Which estimate is looked at: the one of this number, counted from 1, or the last.
    pub fn now(&self, step: Option<f64>) -> usize {
        let count = self.estimates.len().max(1);
        step.map_or(count, |step| (step as usize).clamp(1, count)) - 1
    }
}
