//! Follows a live walk in the same way as firmware does.

use kestirim_imu_calibration::Calibration;
use kestirim_replay::pedestrian::{Follow, Options, build};
use kestirim_telemetry::{Imu, Message};

use super::Sample;
use crate::Error;
use crate::system::{Health, Online, Outcome, Plan};

/// The settings and calibration of a walk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Walking {
    pub(super) options: Options,
    /// The calibration of the IMU, if there is one.
    pub(super) calibration: Option<Calibration<f64>>,
}

impl Plan for Walking {
    fn build(&self) -> Result<Box<dyn Online>, Error> {
        Ok(Box::new(Walker(build(&self.options, self.calibration.as_ref()))))
    }
}

/// A causal tracker.
#[derive(Debug)]
struct Walker(Box<dyn Follow>);

impl Online for Walker {
    fn take(&mut self, message: &Message) -> Outcome {
        let Message::Imu(Imu { time_us, specific_force, angular_rate }) = *message else {
            return Outcome::NotMine;
        };
        let [specific_force, angular_rate] =
            [specific_force, angular_rate].map(|axes| axes.map(f64::from));
        if self.0.take(&Sample { time_us, specific_force, angular_rate }) {
            Outcome::Taken
        } else {
            Outcome::Refused
        }
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.0.finish();
        Ok(())
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.0.position()
    }

    fn is_still(&self) -> bool {
        self.0.is_still()
    }

    fn path_length_m(&self) -> Option<f64> {
        Some(self.0.path_length_m())
    }

    fn health(&self) -> Option<Health> {
        self.0.health()
    }

    fn facts(&self) -> Vec<(String, String)> {
        let strides = self.0.strides();
        let mut facts = vec![
            ("path length".to_owned(), format!("{:.2} m", self.0.path_length_m())),
            ("strides".to_owned(), strides.to_string()),
        ];
        if strides == 0 {
            let guide = "fasten the sensor to the instep so that it cannot wobble, any way up, stand still for 1 s, and walk";
            facts.push(("what to do".to_owned(), guide.to_owned()));
        }
        facts
    }

    fn warnings(&self) -> Vec<String> {
        self.0.warnings()
    }

    fn snapshot(&self) -> Result<Vec<u8>, String> {
        self.0.snapshot().ok_or_else(|| "this tracker cannot be stored".to_owned())
    }

    fn restore(&mut self, snapshot: &[u8]) -> Option<()> {
        self.0.restore(snapshot)
    }
}
