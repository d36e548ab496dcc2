//! `kestirim_uwb_tracker::Tracker` behind the trackers' interface.

use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{Config, InertialSample, OdometrySample, Tracker};
use nalgebra::SVector;

use super::{Follow, Reception, bias_variance, place, sample, with_bias};
use crate::robot::{Error, Event, Inertial, MOST, Setup, TrackerKind, Wheels};
use crate::stored::{behind, read};
use crate::{Number, Stored};

/// A tracker that processes every measurement individually.
#[derive(Debug)]
pub(super) struct Recursive<T: Scalar, const D: usize, const N: usize> {
    tracker: Tracker<T, D, N, MOST>,
    /// Time of the last event, µs.
    now_us: u64,
    height_m: f64,
    /// Whether the prediction is driven by the IMU, as the paper's is.
    pushed: bool,
}

impl<T: Scalar, const D: usize, const N: usize> Recursive<T, D, N> {
    /// A tracker for the anchors of a setup.
    ///
    /// # Errors
    /// [`Error::Anchors`] if the anchors are unsuitable.
    pub(super) fn new(setup: &Setup, config: Config<T>) -> Result<Self, Error> {
        let config = Config { room: setup.room(), ..config };
        let tracker = Tracker::new(config, &setup.anchors())?;
        let pushed = matches!(setup.tracker, TrackerKind::Ekf | TrackerKind::Aekf);
        Ok(Self { tracker, now_us: 0, height_m: setup.height_m, pushed })
    }

    fn bias_variance(&self) -> f64 {
        bias_variance(&self.tracker.health(self.now_us), D)
    }
}

impl<T: Number, const D: usize, const N: usize> Follow for Recursive<T, D, N> {
    fn take(&mut self, time_us: u64, event: &Event) -> Reception {
        let number = T::from_f64;
        self.now_us = time_us;
        let taken = match *event {
            Event::Range(range) => {
                return Reception::of_range(&self.tracker.range(&sample(time_us, &range)));
            }
            Event::Inertial(Inertial { acceleration, push, .. }) => {
                let push = push.filter(|_| self.pushed);
                let sample = InertialSample {
                    time_us,
                    acceleration: SVector::from(acceleration.map(number)),
                    push: push.map(|push| std::array::from_fn(|axis| number(push[axis]))),
                };
                self.tracker.inertial(&sample).is_ok()
            }
            Event::Wheels(Wheels { speed, turn_rate, .. }) => {
                let (speed, turn_rate) = (number(speed), number(turn_rate));
                self.tracker.odometry(&OdometrySample { time_us, speed, turn_rate }).is_ok()
            }
            Event::Height { metres, .. } => {
                let set = self.tracker.set_height(number(metres)).is_ok();
                if set {
                    self.height_m = metres;
                }
                set
            }
            // These events are not used.
            Event::Difference(_) | Event::EpochEnd { .. } => true,
        };
        Reception::unweighed(taken)
    }

    fn position(&self) -> Option<[f64; 3]> {
        place(&self.tracker.position()?, self.height_m)
    }

    fn spread(&self) -> Option<[f64; 3]> {
        with_bias(&self.tracker.estimate()?.covariance, self.bias_variance())
    }

    fn height_variance(&self) -> Option<f64> {
        let covariance = &self.tracker.estimate().filter(|_| D == 3)?.covariance;
        Some(covariance.get(2, 2)?.to_f64() + self.bias_variance())
    }

    fn mirror(&self) -> Option<[f64; 3]> {
        let there = place(&self.tracker.mirror_image()?, self.height_m)?;
        let here = self.position()?;
        Some(std::array::from_fn(|axis| there[axis] - here[axis]))
    }

    fn health(&self) -> kestirim_health::Health {
        self.tracker.health(self.now_us).in_short()
    }

    fn snapshot(&self) -> Option<Vec<u8>> {
        Some(behind([self.now_us, self.height_m.to_bits()], &self.tracker.stored()?))
    }

    fn restore(&mut self, snapshot: &[u8]) -> Option<()> {
        let ([now_us, height], tracker) = read(snapshot)?;
        self.tracker = Stored::restored(tracker)?;
        (self.now_us, self.height_m) = (now_us, f64::from_bits(height));
        Some(())
    }
}
