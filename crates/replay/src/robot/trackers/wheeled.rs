//! `kestirim_uwb_tracker::WheelTracker` behind the trackers' interface.

use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{Config, OdometrySample, WheelTracker};

use super::{Follow, Reception, bias_variance, place, sample, with_bias};
use crate::robot::{Error, Event, MOST, Setup, Wheels};

/// A tracker that is moved by the wheels, and processes every range individually.
#[derive(Debug)]
pub(super) struct Wheeled<T: Scalar> {
    tracker: WheelTracker<T, MOST>,
    /// Time of the last event, µs.
    now_us: u64,
    height_m: f64,
}

impl<T: Scalar> Wheeled<T> {
    /// A tracker for the anchors of a setup.
    ///
    /// # Errors
    /// [`Error::Anchors`] if the anchors are unsuitable.
    pub(super) fn new(setup: &Setup, config: Config<T>) -> Result<Self, Error> {
        let config = Config { room: setup.room(), ..config };
        let tracker = WheelTracker::new(config, &setup.anchors())?;
        Ok(Self { tracker, now_us: 0, height_m: setup.height_m })
    }
}

impl<T: Scalar> Follow for Wheeled<T> {
    fn take(&mut self, time_us: u64, event: &Event) -> Reception {
        let number = T::from_f64;
        self.now_us = time_us;
        let taken = match *event {
            Event::Range(range) => {
                return Reception::of_range(&self.tracker.range(&sample(time_us, &range)));
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
            // Other events are not used.
            _ => true,
        };
        Reception::unweighed(taken)
    }

    fn position(&self) -> Option<[f64; 3]> {
        place(&self.tracker.position()?, self.height_m)
    }

    fn spread(&self) -> Option<[f64; 3]> {
        let bias = bias_variance(&self.tracker.health(self.now_us), 2);
        with_bias(&self.tracker.estimate()?.covariance, bias)
    }

    fn health(&self) -> kestirim_health::Health {
        self.tracker.health(self.now_us).in_short()
    }
}
