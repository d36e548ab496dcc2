//! A robot with wheel odometry, in every scalar.

use crate::common::{CORNERS, anchors, distance, in_every_scalar, sample};
use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{Config, Error, OdometrySample, State, WheelTracker};

/// A field of 64 m × 48 m, with anchors in its corners.
fn field() -> [[f64; 3]; 4] {
    CORNERS.map(|[x, y, z]| [8.0 * (x - 4.0), 8.0 * (y - 3.0), z])
}

/// Errors of the radios and the wheels.
#[derive(Clone, Copy)]
struct Wrong {
    /// Relative excess of the ranges.
    excess: f64,
    /// Factors of speeds and turn rates.
    speed: f64,
    turn: f64,
    /// Amount missing from the turn rate, rad/s.
    drift: f64,
}

const RIGHT: Wrong = Wrong { excess: 0.0, speed: 1.0, turn: 1.0, drift: 0.0 };

/// A robot that drives loops through the field at 1 m/s, with two ranges per second.
struct Drive<T: Scalar> {
    tracker: WheelTracker<T, 4>,
    places: [[f64; 3]; 4],
    place: [f64; 2],
    heading: f64,
    step: u64,
}

impl<T: Scalar> Drive<T> {
    fn new() -> Self {
        Self::among(field(), [4.0, -12.0])
    }

    fn among(places: [[f64; 3]; 4], place: [f64; 2]) -> Self {
        let config = Config::uncalibrated(T::ZERO);
        let tracker = WheelTracker::new(config, &anchors(&places, 0.0)).unwrap();
        Self { tracker, places, place, heading: 0.7, step: 0 }
    }

    /// Drives on for this many steps of 0.1 s.
    fn on(&mut self, steps: u64, wrong: Wrong, with_wheels: bool) {
        for _ in 0..steps {
            self.step += 1;
            let time_us = 100_000 * self.step;
            let turn_rate = 0.15 * (0.02 * self.step as f64).sin() + 0.05;
            self.heading += 0.1 * turn_rate;
            self.place[0] += 0.1 * self.heading.cos();
            self.place[1] += 0.1 * self.heading.sin();
            if with_wheels {
                let speed = T::from_f64(wrong.speed);
                let turn_rate = T::from_f64(wrong.turn * (turn_rate - wrong.drift));
                self.tracker.odometry(&OdometrySample { time_us, speed, turn_rate }).unwrap();
            }
            if self.step.is_multiple_of(5) {
                let anchor = (self.step / 5 % 4) as usize;
                let noise = 0.2 * ((self.step * 7919 % 101) as f64 / 50.0 - 1.0);
                let far = distance(self.places[anchor], [self.place[0], self.place[1], 0.0]);
                let range = far * (1.0 + wrong.excess) + noise;
                self.tracker.range(&sample(time_us, anchor, range)).unwrap();
            }
        }
    }

    fn error(&self) -> f64 {
        let position = self.tracker.position().expect("there is a position");
        (position[0].to_f64() - self.place[0]).hypot(position[1].to_f64() - self.place[1])
    }
}

#[test]
fn heading_scale_sign_and_drift_are_found() {
    fn check<T: Scalar>() {
        for (wrong, scale) in [
            (RIGHT, 1.0),
            (Wrong { excess: 0.06, ..RIGHT }, 1.0),
            (Wrong { speed: 0.8, turn: -1.2, ..RIGHT }, 1.25),
            (Wrong { speed: -1.0, drift: 0.01, ..RIGHT }, 1.0),
        ] {
            let mut drive = Drive::<T>::new();
            drive.on(3000, wrong, true);
            let (error, found) = (drive.error(), drive.tracker.scale().unwrap().to_f64());
            assert!(error < 0.5, "{error}");
            assert!((found - scale).abs() < 0.1, "{found}");
        }
    }
    in_every_scalar!(check);
}

#[test]
fn without_wheels_it_follows_the_ranges_and_says_how_well() {
    fn check<T: Scalar>() {
        let mut drive = Drive::<T>::new();
        drive.on(1500, RIGHT, true);
        drive.on(300, RIGHT, false);
        let sigma = drive.tracker.health(100_000 * drive.step).position_sigma.unwrap().to_f64();
        assert!(drive.error() < 3.0 * sigma && sigma < 3.0, "{} {sigma}", drive.error());
        drive.on(600, RIGHT, true);
        assert!(drive.error() < 0.5, "{}", drive.error());
    }
    in_every_scalar!(check);
}

#[test]
fn a_sample_after_a_silence_says_nothing_about_the_silence() {
    fn check<T: Scalar>() {
        let mut drive = Drive::<T>::new();
        drive.on(600, RIGHT, true);
        assert!(drive.error() < 2.0, "{} m", drive.error());
        // It stood meanwhile, and has just set off.
        let time_us = 100_000 * drive.step + 10_000_000;
        let (speed, turn_rate) = (T::ONE, T::ZERO);
        drive.tracker.odometry(&OdometrySample { time_us, speed, turn_rate }).unwrap();
        let sigma = drive.tracker.health(time_us).position_sigma;
        let is_honest = sigma.is_none_or(|sigma| drive.error() < 3.0 * sigma.to_f64());
        assert!(is_honest, "{} m, {sigma:?}", drive.error());
    }
    in_every_scalar!(check);
}

#[test]
fn a_robot_of_which_nothing_was_heard_may_have_gone_on() {
    fn check<T: Scalar>() {
        let mut drive = Drive::<T>::new();
        drive.on(1500, RIGHT, true);
        let now_us = 100_000 * drive.step;
        let sigma = |seconds: u64| {
            let health = drive.tracker.health(now_us + 1_000_000 * seconds);
            health.position_sigma.map(T::to_f64)
        };
        let (now, later) = (sigma(0).unwrap(), sigma(10).unwrap());
        assert!(later > now.hypot(1.0), "{now} {later}");
        assert_eq!(sigma(3600), None);
    }
    in_every_scalar!(check);
}

#[test]
fn anchors_in_a_line_do_not_tell_its_sides_apart() {
    fn check<T: Scalar>() {
        let line = [-24.0, -8.0, 8.0, 24.0].map(|x| [x, 0.0, 2.0]);
        let mut drive = Drive::<T>::among(line, [4.0, -8.0]);
        drive.on(600, RIGHT, true);
        let health = drive.tracker.health(100_000 * drive.step);
        let (mirror, sigma) = (health.mirror.unwrap(), health.position_sigma.unwrap());
        assert!((mirror.to_f64() - 2.0 * drive.place[1].abs()).abs() < 2.0, "{mirror:?}");
        assert!(
            drive.error() < 3.0 * sigma.to_f64()
                && health.in_short() != kestirim_health::Health::GOOD
        );
        let mut drive = Drive::<T>::new();
        drive.on(600, RIGHT, true);
        assert_eq!(drive.tracker.health(100_000 * drive.step).mirror, None);
    }
    in_every_scalar!(check);
}

#[test]
fn what_wheels_cannot_say_is_refused() {
    let mut drive = Drive::<f32>::new();
    drive.on(100, RIGHT, true);
    let wheels = |speed, turn_rate| OdometrySample { time_us: 10_100_000, speed, turn_rate };
    for (sample, error) in [
        (wheels(f32::NAN, 0.0), Error::NotFinite),
        (wheels(1.0, 500.0), Error::ImplausibleMotion),
        (OdometrySample { time_us: 1_000_000, ..wheels(1.0, 0.0) }, Error::OutOfOrder),
    ] {
        assert_eq!(drive.tracker.odometry(&sample), Err(error));
    }
    assert_eq!(drive.tracker.health(10_000_000).state, State::Tracking);
    assert!(drive.tracker.set_height(f32::INFINITY).is_err());
}
