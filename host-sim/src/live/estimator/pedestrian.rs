//! A walk, followed as firmware follows it.

use kestirim_pedestrian::{Config, EkfTracker, Estimate, ImuSample};
use kestirim_telemetry::{Imu, Message};
use nalgebra::SVector;

use super::{Estimator, Outcome};
use crate::systems::pedestrian::options::SensorClass;
use crate::systems::pedestrian::warning;

/// What is known beforehand.
#[derive(Debug, Clone, Copy)]
pub(in crate::live) struct Plan {
    pub(super) sensor: SensorClass,
}

impl Plan {
    pub(super) fn build(self) -> Walker {
        let config = Config { sensor: self.sensor.into(), ..Config::default() };
        Walker { tracker: EkfTracker::new(config), last: None, strides: 0 }
    }
}

/// The default tracker, in single precision.
#[derive(Debug)]
pub(super) struct Walker {
    tracker: EkfTracker<f32>,
    last: Option<Estimate<f32>>,
    strides: u32,
}

impl Estimator for Walker {
    fn take(&mut self, message: &Message) -> Outcome {
        let Message::Imu(Imu { time_us, specific_force, angular_rate }) = *message else {
            return Outcome::NotMine;
        };
        let sample = ImuSample {
            time_us,
            specific_force: SVector::from(specific_force),
            angular_rate: SVector::from(angular_rate),
        };
        let Ok(estimate) = self.tracker.update(&sample) else { return Outcome::Refused };
        self.strides += u32::from(estimate.stride.is_some());
        self.last = Some(estimate);
        Outcome::Taken
    }

    fn finish(&mut self) {
        self.strides += u32::from(self.tracker.finish().is_some());
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.last.as_ref().map(|estimate| estimate.position.data.0[0].map(f64::from))
    }

    fn is_still(&self) -> bool {
        self.last.as_ref().is_some_and(|estimate| estimate.stance)
    }

    fn path_length_m(&self) -> Option<f64> {
        Some(f64::from(self.tracker.path_length()))
    }

    fn facts(&self) -> Vec<(String, String)> {
        let length = format!("{:.2} m", self.tracker.path_length());
        vec![("path length".to_owned(), length), ("strides".to_owned(), self.strides.to_string())]
    }

    fn warnings(&self) -> Vec<String> {
        // Whether a foot ever stood is not known before it did.
        if self.last.is_some() { warning::sentences(self.tracker.warnings()) } else { Vec::new() }
    }
}
