//! A flight frame by frame: what a drawing needs of it.

use super::cloud::Cloud;
use super::scenario::EnvironmentKind;
use crate::metrics::distance;

/// What was known after a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Where the drone measured, m: with its height.
    pub drone: [f64; 3],
    /// Where the user really was, m.
    pub user: [f64; 2],
    /// What was measured, dB.
    pub loss_db: f64,
    /// Where the filter says that the user is, m.
    pub estimate: [f64; 2],
    /// All that it believes.
    pub cloud: Cloud,
}

impl Frame {
    /// Distance of the estimate from the user, m.
    pub fn error_m(&self) -> f64 {
        distance(self.user, self.estimate)
    }

    /// What the channel expects of a user at a place, dB; none right at the drone.
    pub fn expected_db(&self, environment: EnvironmentKind, place: [f64; 2]) -> Option<f64> {
        let [x, y, height] = self.drone;
        let loss = environment.channel::<f64>().path_loss(distance([x, y], place), height);
        loss.ok().map(|loss| loss.mean())
    }
}
