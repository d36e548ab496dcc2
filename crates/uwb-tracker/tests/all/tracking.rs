//! A tracker with good and bad ranges, in every scalar.

use crate::common::{CORNERS, anchors, distance, in_every_scalar, sample};
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_tracker::{
    Anchor, CalibratedPlaneTracker, CalibratedSpaceTracker, Config, Error, InertialSample,
    OdometrySample, Outcome, Report, State, Tracker,
};
use nalgebra::{Vector2, Vector3};
use rand_distr::{Distribution, StandardUniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

const TAG: [f64; 2] = [3.0, 2.0];

/// A tracker in the plane at a height of 1 m.
struct Bench<T: Scalar, const N: usize> {
    tracker: Tracker<T, 2, N, 8>,
    time_us: u64,
    random: Xoshiro256PlusPlus,
}

impl<T: Scalar, const N: usize> Bench<T, N> {
    fn new(config: Config<T>) -> Self {
        let tracker = Tracker::new(config, &anchors(&CORNERS, 0.0)).unwrap();
        Self { tracker, time_us: 0, random: Xoshiro256PlusPlus::seed_from_u64(1) }
    }

    /// Noise from −1 to 1.
    fn noise(&mut self) -> f64 {
        let share: f64 = StandardUniform.sample(&mut self.random);
        2.0 * share - 1.0
    }

    /// One epoch of all corners, 0.1 s after the last; `excess` is added to the ranges.
    fn epoch(&mut self, tag: [f64; 2], excess: [f64; 4]) -> Vec<Report<T>> {
        self.time_us += 100_000;
        let tag = [tag[0], tag[1], 1.0];
        (0..4)
            .map(|anchor| {
                let range = distance(CORNERS[anchor], tag) + excess[anchor] + 0.05 * self.noise();
                self.tracker.range(&sample(self.time_us, anchor, range)).unwrap()
            })
            .collect()
    }

    /// Distance of the position from the tag, m.
    fn error(&self, tag: [f64; 2]) -> f64 {
        let position = self.tracker.position().expect("there is a position");
        (position[0].to_f64() - tag[0]).hypot(position[1].to_f64() - tag[1])
    }
}

fn check_circle<T: Scalar>() {
    let mut bench = Bench::<T, 4>::new(Config::calibrated(T::ONE));
    let mut worst = 0.0_f64;
    for k in 0..400 {
        let angle = 0.02 * f64::from(k);
        let tag = [4.0 + 2.0 * angle.cos(), 3.0 + 1.5 * angle.sin()];
        bench.epoch(tag, [0.0; 4]);
        if k > 10 {
            worst = worst.max(bench.error(tag));
        }
    }
    assert!(worst < 0.15, "{worst}");
    let velocity = bench.tracker.velocity().unwrap().map(T::to_f64);
    assert!((velocity.norm() - 0.35).abs() < 0.15, "{velocity}");
    let health = bench.tracker.health(bench.time_us);
    assert_eq!((health.state, health.heard, health.rejected), (State::Tracking, 4, 0));
    assert!((0.9..2.0).contains(&health.dilution.unwrap().to_f64()));
    assert!(health.position_sigma.unwrap().to_f64() < 0.2);
    assert!(health.nis.to_f64() < 3.0);
}

#[test]
fn a_circle_is_followed() {
    in_every_scalar!(check_circle);
}

fn check_space<T: Scalar>() {
    let places =
        [[0.0, 0.0, 2.5], [8.0, 0.0, 0.2], [8.0, 6.0, 2.5], [0.0, 6.0, 0.2], [4.0, 3.0, 3.0]];
    let mut tracker =
        CalibratedSpaceTracker::<T, 5>::new(Config::calibrated(T::ZERO), &anchors(&places, 0.0))
            .unwrap();
    let tag = [2.0, 4.0, 1.2];
    for k in 0..100_u64 {
        for (anchor, &place) in places.iter().enumerate() {
            tracker.range(&sample(100_000 * k, anchor, distance(place, tag))).unwrap();
        }
    }
    let position = tracker.position().unwrap().map(T::to_f64);
    assert!((position - Vector3::from(tag)).norm() < 0.05, "{position}");
}

#[test]
fn a_tag_in_space_is_found() {
    in_every_scalar!(check_space);
}

fn check_common_bias<T: Scalar>() {
    let run = |mut errors: Vec<f64>, with_bias: bool| {
        let (mut five, mut four) = (
            Bench::<T, 5>::new(Config::uncalibrated(T::ONE)),
            Bench::<T, 4>::new(Config::uncalibrated(T::ONE)),
        );
        for _ in 0..200 {
            five.epoch(TAG, [0.3; 4]);
            four.epoch(TAG, [0.3; 4]);
        }
        errors.push(if with_bias { five.error(TAG) } else { four.error(TAG) });
        errors[0]
    };
    let (with, without) = (run(vec![], true), run(vec![], false));
    assert!(with < 0.03, "{with}");
    assert!(without > 2.0 * with, "{without}");
}

#[test]
fn a_common_bias_is_learnt() {
    in_every_scalar!(check_common_bias);
}

fn check_person<T: Scalar>() {
    let mut robust = Bench::<T, 4>::new(Config::calibrated(T::ONE));
    let mut plain = Bench::<T, 4>::new(Config::plain(T::ONE));
    for k in 0..600 {
        let excess = if k > 50 { [0.0, 0.8, 0.0, 0.0] } else { [0.0; 4] };
        robust.epoch(TAG, excess);
        plain.epoch(TAG, excess);
    }
    assert!(robust.error(TAG) < 0.05, "{}", robust.error(TAG));
    assert!(plain.error(TAG) > 0.2, "{}", plain.error(TAG));
    let sigma = |anchor| robust.tracker.range_sigma(anchor).unwrap().to_f64();
    assert!(sigma(1) > 3.0 * sigma(0), "the anchor behind the person is known by its variance");
}

#[test]
fn a_person_in_the_way_of_one_anchor_is_outvoted() {
    in_every_scalar!(check_person);
}

fn check_outage<T: Scalar>(seconds: u64) {
    let mut bench = Bench::<T, 4>::new(Config::calibrated(T::ONE));
    for k in 0..50 {
        bench.epoch([2.0 + 0.1 * f64::from(k), 2.0], [0.0; 4]);
    }
    let there = bench.tracker.position().unwrap().map(T::to_f64);
    bench.time_us += 1_000_000 * seconds;
    // After a minute it may be anywhere.
    let state = if seconds < 60 { State::Coasting } else { State::Lost };
    assert_eq!(bench.tracker.health(bench.time_us).state, state);
    for _ in 0..10 {
        bench.epoch([1.0, 5.0], [0.0; 4]);
    }
    assert!((there[0] - 6.9).abs() < 0.2);
    assert!(bench.error([1.0, 5.0]) < 0.2, "{}", bench.error([1.0, 5.0]));
}

#[test]
fn after_an_outage_it_is_found_again() {
    check_outage::<f32>(3);
    check_outage::<f32>(10);
    check_outage::<f32>(10_000);
    check_outage::<f64>(10);
    check_outage::<Q12_20>(10);
    check_outage::<Q12_20>(100_000);
}

#[test]
fn a_tag_that_was_carried_elsewhere_is_found_again() {
    let mut bench = Bench::<f32, 4>::new(Config::calibrated(1.0));
    for _ in 0..100 {
        bench.epoch([1.0, 1.0], [0.0; 4]);
    }
    let mut rejected = false;
    for _ in 0..10 {
        let reports = bench.epoch([7.0, 5.0], [0.0; 4]);
        rejected |= reports.iter().any(|report| report.outcome == Outcome::Rejected);
    }
    assert!(rejected, "it is not believed at once");
    assert!(bench.error([7.0, 5.0]) < 0.2);
    assert!(bench.tracker.health(bench.time_us).restarts >= 1);
}

#[test]
fn the_first_position_waits_for_all_anchors_or_a_second_round() {
    let places = anchors::<f32>(&CORNERS, 0.0);
    let mut tracker =
        CalibratedPlaneTracker::<f32, 4>::new(Config::calibrated(1.0), &places).unwrap();
    let tag = [3.0, 2.0, 1.0];
    let mut offer = |time_us, anchor: usize| {
        let range = distance(CORNERS[anchor], tag);
        tracker.range(&sample(time_us, anchor, range)).unwrap().outcome
    };
    // The third corner is silent.
    assert_eq!(offer(0, 0), Outcome::Collected);
    assert_eq!(offer(0, 1), Outcome::Collected);
    assert_eq!(offer(0, 3), Outcome::Collected);
    // From here on a position is searched for, a few steps with each range.
    let started =
        (1..10).find(|&k| offer(100_000 * k, [3, 0, 1][k as usize % 3]) == Outcome::Started);
    assert!(started.is_some_and(|k| (2..7).contains(&k)), "{started:?}");
    assert_eq!(tracker.health(700_000).restarts, 0);
    assert!((tracker.position().unwrap().x - 3.0).abs() < 0.1);
}

fn check_blocked<T: Scalar>() {
    // Permanently, from the first range on: one of five anchors is behind a wall.
    let places: [[f64; 3]; 5] =
        std::array::from_fn(|k| if k < 4 { CORNERS[k] } else { [4.0, 0.0, 1.5] });
    let mut tracker =
        CalibratedPlaneTracker::<T, 5>::new(Config::calibrated(T::ONE), &anchors(&places, 0.0))
            .unwrap();
    for k in 0..300_u64 {
        let tag = [3.0 + 0.005 * k as f64, 2.0, 1.0];
        for (anchor, &place) in places.iter().enumerate() {
            let excess = if anchor == 2 { 6.0 } else { 0.0 };
            let range = distance(place, tag) + excess;
            tracker.range(&sample(100_000 * k, anchor, range)).unwrap();
        }
        let Some(position) = tracker.position() else {
            assert!(k < 3, "a position after {k} epochs");
            continue;
        };
        let error = (position[0].to_f64() - tag[0]).hypot(position[1].to_f64() - tag[1]);
        assert!(error < 0.3, "{k}: {error}");
    }
    let health = tracker.health(29_900_000);
    assert_eq!((health.restarts, health.state), (0, State::Tracking));
}

#[test]
fn an_anchor_behind_a_wall_is_no_reason_to_be_lost() {
    in_every_scalar!(check_blocked);
}

fn check_slow<T: Scalar>() {
    // Each anchor is heard every 2.4 s.
    let mut tracker =
        CalibratedPlaneTracker::<T, 4>::new(Config::calibrated(T::ONE), &anchors(&CORNERS, 0.0))
            .unwrap();
    for k in 0..100_u64 {
        let anchor = (k % 4) as usize;
        let range = distance(CORNERS[anchor], [3.0, 2.0, 1.0]);
        tracker.range(&sample(600_000 * k, anchor, range)).unwrap();
        assert_eq!(tracker.position().is_some(), k >= 3, "{k}");
    }
    let health = tracker.health(59_400_000);
    assert_eq!((health.state, health.heard), (State::Tracking, 4));
    assert_eq!(tracker.health(59_400_000 + 6_000_000).state, State::Coasting);
}

#[test]
fn ranges_that_come_slowly_make_a_position_all_the_same() {
    in_every_scalar!(check_slow);
}

#[test]
fn an_imu_at_rest_holds_the_position() {
    let still = Vector3::new(0.1_f32, -0.2, 9.8);
    let wander = |imu: bool| {
        let mut bench = Bench::<f32, 4>::new(Config::uncalibrated(1.0));
        let mut path = 0.0;
        let mut last: Option<Vector2<f32>> = None;
        for _ in 0..300 {
            bench.epoch(TAG, [0.0; 4]);
            for step in 1..5 {
                let time_us = bench.time_us + 20_000 * step;
                let sample = InertialSample { time_us, acceleration: still, push: None };
                if imu {
                    bench.tracker.inertial(&sample).unwrap();
                }
            }
            let position = bench.tracker.position().unwrap();
            path += last.map_or(0.0, |last| (position - last).norm());
            last = Some(position);
        }
        (path, bench.tracker.health(bench.time_us + 80_000).still)
    };
    let ((held, still), (free, _)) = (wander(true), wander(false));
    assert!(still && held < 0.6 * free, "{held} of {free} m");
}

#[test]
fn an_acceleration_does_not_last_over_a_gap() {
    let pushed = |after_us: u64| {
        let mut bench = Bench::<f64, 4>::new(Config::calibrated(1.0));
        for _ in 0..50 {
            bench.epoch(TAG, [0.0; 4]);
        }
        let (time_us, acceleration) = (bench.time_us + after_us, Vector3::new(5.0, 0.0, 9.8));
        let sample = InertialSample { time_us, acceleration, push: Some([5.0, 0.0]) };
        bench.tracker.inertial(&sample).unwrap();
        bench.tracker.velocity().unwrap()[0]
    };
    let (at_once, late) = (pushed(100_000), pushed(1_000_000));
    assert!(at_once > 0.3 && late.abs() < 0.05, "{at_once} {late} m/s");
}

#[test]
fn a_smooth_ride_is_not_taken_for_standing() {
    // A trolley at 1 m/s that does not shake at all.
    let mut bench = Bench::<f32, 4>::new(Config::calibrated(1.0));
    for k in 0..60 {
        let tag = [1.0 + 0.1 * f64::from(k), 3.0];
        for step in 1..5 {
            let time_us = bench.time_us + 20_000 * step;
            let acceleration = Vector3::new(0.0, 0.0, 9.8);
            bench.tracker.inertial(&InertialSample { time_us, acceleration, push: None }).unwrap();
        }
        bench.epoch(tag, [0.0; 4]);
        assert!(k < 20 || bench.error(tag) < 0.35, "{k}: {}", bench.error(tag));
    }
}

#[test]
fn wheels_measure_the_speed_of_a_straight_drive() {
    let speed = |wheels: bool| {
        let mut bench = Bench::<f64, 4>::new(Config::calibrated(1.0));
        let mut worst = 0.0_f64;
        for k in 0..100 {
            bench.epoch([1.0 + 0.05 * f64::from(k), 3.0], [0.0; 4]);
            let sample = OdometrySample { time_us: bench.time_us, speed: 0.5, turn_rate: 0.0 };
            if wheels {
                bench.tracker.odometry(&sample).unwrap();
            }
            if k > 30 {
                worst = worst.max((bench.tracker.velocity().unwrap().x - 0.5).abs());
            }
        }
        worst
    };
    assert!(speed(true) < 0.7 * speed(false), "{} {}", speed(true), speed(false));
}

#[test]
fn a_push_moves_the_prediction() {
    let mut bench = Bench::<f64, 4>::new(Config::plain(1.0));
    for _ in 0..100 {
        bench.epoch(TAG, [0.0; 4]);
    }
    let before = bench.tracker.velocity().unwrap();
    for step in 1..=50 {
        let time_us = bench.time_us + 10_000 * step;
        let acceleration = Vector3::new(9.0, 0.0, 9.8);
        let sample = InertialSample { time_us, acceleration, push: Some([2.0, 0.0]) };
        bench.tracker.inertial(&sample).unwrap();
    }
    let gained = bench.tracker.velocity().unwrap() - before;
    assert!((gained.x - 1.0).abs() < 0.01 && gained.y.abs() < 0.01, "{gained}");
}

#[test]
fn impossible_trackers_are_refused() {
    let nine = anchors::<f32>(&[[0.0; 3]; 9], 0.0);
    let refused = |anchors: &[Anchor<f32>]| {
        CalibratedPlaneTracker::<f32, 8>::new(Config::calibrated(1.0), anchors).err()
    };
    assert_eq!(refused(&nine), Some(Error::TooManyAnchors));
    assert_eq!(refused(&anchors(&CORNERS, f64::NAN)), Some(Error::NotFinite));
    let mut tracker = CalibratedPlaneTracker::<f32, 8>::new(Config::calibrated(1.0), &[]).unwrap();
    assert_eq!(tracker.range(&sample(0, 0, 1.0)), Err(Error::NoSuchAnchor));
    assert_eq!(tracker.set_height(f32::INFINITY), Err(Error::NotFinite));
}

#[test]
fn a_slow_radio_finds_a_position_among_ranges_that_contradict_each_other() {
    // A range every 0.4 s, one anchor always behind an obstacle.
    let mut found_after = Vec::new();
    for place in 0..25_u32 {
        let tag = [1.0 + 1.5 * f64::from(place % 5), 1.0 + f64::from(place / 5)];
        let mut bench = Bench::<f64, 4>::new(Config::calibrated(1.0));
        let found = (0..40_usize).find(|&count| {
            bench.time_us += 400_000;
            let anchor = count % 4;
            let excess = if anchor == 1 { 6.0 } else { 0.0 };
            let range = distance(CORNERS[anchor], [tag[0], tag[1], 1.0]) + excess;
            let range = range + 0.05 * bench.noise();
            bench.tracker.range(&sample(bench.time_us, anchor, range)).unwrap();
            bench.tracker.position().is_some()
        });
        found_after.push(found.unwrap_or(99));
    }
    assert!(found_after.iter().all(|ranges| *ranges <= 12), "{found_after:?}");
}
