//! A robot that moves without shaking, so that its IMU reads as if it stood still.

use crate::common::{CORNERS, anchors, distance, in_every_scalar, sample};
use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{Config, InertialSample, Tracker};
use nalgebra::Vector3;
use rand_distr::{Distribution, StandardUniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// Mean position error, m, for a tag whose x is `way(seconds)`, in the ten seconds before `until`, s. No range arrives
/// while it is `silent`.
fn error<T: Scalar>(way: impl Fn(f64) -> f64, silent: impl Fn(f64) -> bool, until: u32) -> f64 {
    let mut tracker =
        Tracker::<T, 2, 5, 4>::new(Config::uncalibrated(T::ONE), &anchors(&CORNERS, 0.0)).unwrap();
    let (mut random, mut sum, mut count) = (Xoshiro256PlusPlus::seed_from_u64(1), 0.0, 0_u32);
    for step in 0..40 * until {
        let seconds = 0.025 * f64::from(step);
        let time_us = 25_000 * u64::from(step);
        let acceleration = Vector3::new(0.0, 0.0, 9.8).map(T::from_f64);
        tracker.inertial(&InertialSample { time_us, acceleration, push: None }).unwrap();
        let tag = [way(seconds), 2.5, 1.0];
        let share: f64 = StandardUniform.sample(&mut random);
        let off = 0.1 * (share - 0.5);
        if !silent(seconds) {
            let anchor = step as usize % 4;
            let range = distance(CORNERS[anchor], tag) + off;
            tracker.range(&sample(time_us, anchor, range)).unwrap();
        }
        if let Some(position) = tracker.position()
            && step + 400 >= 40 * until
        {
            sum += (position[0].to_f64() - tag[0]).hypot(position[1].to_f64() - tag[1]);
            count += 1;
        }
    }
    sum / f64::from(count)
}

fn check_slow<T: Scalar>() {
    // Between 1 and 7 m, back and forth.
    for speed in [0.03, 0.05, 0.1] {
        let way = |seconds: f64| {
            let along = speed * seconds % 12.0;
            1.0 + along.min(12.0 - along)
        };
        let off = error::<T>(way, |_| false, 120);
        assert!(off < 0.15, "{speed} m/s: {off} m");
    }
}

#[test]
fn a_slow_robot_is_followed() {
    in_every_scalar!(check_slow);
}

/// A robot at 1 m/s without ranges for two seconds of every ten: each time its velocity may be zero again, as far as
/// is known.
#[test]
fn a_robot_whose_ranges_stay_away_is_not_held_again_and_again() {
    let way = |seconds: f64| 4.0 + 2.5 * (0.4 * seconds).sin();
    let off = error::<f64>(way, |seconds| seconds % 10.0 < 2.0, 100);
    assert!(off < 0.5, "{off} m");
}
