//! Measurements, and the estimated place of the user after each.

use kestirim_air_to_ground::Rotor;

use super::{Estimate, Stop};
use crate::metrics::distance;

/// The flight of a synthetic drone.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Flown {
    /// The length of the path, m.
    pub path_m: f64,
    /// The sum of all climbs, m.
    pub climb_m: f64,
    /// The time spent hovering, s.
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
    /// The name in the log.
    pub name: String,
    /// The estimate after the last measurement; `None` if no place explains the measurements, or if there are fewer
    /// than three.
    pub estimate: Option<Estimate>,
    /// The true place at that time, if known.
    pub truth: Option<[f64; 2]>,
}

impl Other {
    /// The distance of the estimate from the truth, if that is known, m.
    pub fn error_m(&self) -> Option<f64> {
        Some(distance(self.estimate.as_ref()?.place, self.truth?))
    }
}

/// Measurements, and the estimates after each one that some place explains.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Track {
    /// The measurements that are used.
    pub stops: Vec<Stop>,
    /// The true place of the user at each measurement; empty if unknown.
    pub truth: Vec<[f64; 2]>,
    /// The estimates, in the order of the measurements.
    pub estimates: Vec<Estimate>,
    /// Warnings for the reader.
    pub warnings: Vec<String>,
    /// The distance (m) between the places from the first and the last third of the flight, for a user who is assumed
    /// to stay, if it is not chance.
    pub moved_m: Option<f64>,
    /// The flight, if the drone is synthetic.
    pub flown: Option<Flown>,
    /// Other transmitters that were heard on the same flight.
    pub others: Vec<Other>,
}

impl Track {
    /// The measurement of an estimate.
    pub fn stop(&self, estimate: &Estimate) -> Stop {
        self.stops[estimate.stop]
    }

    /// The true place of the user at an estimate, if known.
    pub fn user(&self, estimate: &Estimate) -> Option<[f64; 2]> {
        self.truth.get(estimate.stop).copied()
    }

    /// The distance of an estimate from the true place of the user, if known, m.
    pub fn error_m(&self, estimate: &Estimate) -> Option<f64> {
        Some(distance(self.user(estimate)?, estimate.place))
    }

    /// The time of an estimate, s since the first measurement.
    pub fn seconds(&self, estimate: &Estimate) -> f64 {
        self.stop(estimate).t - self.stops.first().map_or(0.0, |stop| stop.t)
    }

    /// The index of the estimate that is shown: the one of this number, counted from 1, or the last.
    pub fn now(&self, step: Option<f64>) -> usize {
        let count = self.estimates.len().max(1);
        step.map_or(count, |step| (step as usize).clamp(1, count)) - 1
    }
}
