//! Single parts that the trackers' other tests do not distinguish, at their limits.

mod dimensions;
mod published;
mod standing;

use crate::common::{CORNERS, anchors, distance, sample};
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_tracker::{
    CalibratedPlaneTracker, Config, Error, InertialSample, OdometrySample, Outcome, RangeSample,
    State,
};
use nalgebra::{Vector2, Vector3};

type Plane = CalibratedPlaneTracker<f64, 4>;

/// Half a metre per second along the room, 1 m high.
const SPEED: f64 = 0.5;

fn on_the_way(time_us: u64) -> [f64; 3] {
    [1.0 + SPEED * time_us as f64 * 1e-6, 2.0, 1.0]
}

/// Feeds the ranges of all corners for a tag at a place.
fn hear(tracker: &mut Plane, time_us: u64, tag: [f64; 3]) {
    for (anchor, &place) in CORNERS.iter().enumerate() {
        tracker.range(&sample(time_us, anchor, distance(place, tag))).expect("a range");
    }
}

/// The time of the last range of [`following`] (µs).
const NOW_US: u64 = 5_000_000;

/// A tracker that has followed a moving tag.
fn following(config: Config<f64>) -> Plane {
    let mut tracker = Plane::new(config, &anchors(&CORNERS, 0.0)).expect("a room");
    for time_us in (0..=NOW_US).step_by(100_000) {
        hear(&mut tracker, time_us, on_the_way(time_us));
    }
    tracker
}

fn wheels(time_us: u64, speed: f64, turn_rate: f64) -> OdometrySample<f64> {
    OdometrySample { time_us, speed, turn_rate }
}

fn inertial(time_us: u64, push: Option<[f64; 2]>) -> InertialSample<f64, 2> {
    InertialSample { time_us, acceleration: Vector3::new(0.0, 0.0, 9.8), push }
}

#[test]
fn a_sample_may_be_a_tenth_of_a_second_late() {
    for (late_us, result) in [(100_000, Ok(())), (100_001, Err(Error::OutOfOrder))] {
        let mut tracker = following(Config::calibrated(1.0));
        tracker.inertial(&inertial(NOW_US + 200_000, None)).expect("a sample");
        let time_us = NOW_US + 200_000 - late_us;
        let range = distance(CORNERS[0], on_the_way(time_us));
        assert_eq!(tracker.range(&sample(time_us, 0, range)).map(drop), result);
        assert_eq!(tracker.inertial(&inertial(time_us, None)), result);
        assert_eq!(tracker.odometry(&wheels(time_us, 0.5, 0.0)), result);
    }
}

#[test]
fn what_nothing_that_carries_a_tag_does_is_refused() {
    let mut tracker = following(Config::calibrated(1.0));
    for (size, result) in [
        (0.999, Ok(())),
        (1.001, Err(Error::ImplausibleMotion)),
        (f64::INFINITY, Err(Error::NotFinite)),
        (f64::NAN, Err(Error::NotFinite)),
    ] {
        for sign in [1.0, -1.0] {
            let (speed, acceleration) = (100.0 * size * sign, 500.0 * size * sign);
            assert_eq!(tracker.odometry(&wheels(NOW_US, speed, 0.0)), result, "{speed} m/s");
            assert_eq!(tracker.odometry(&wheels(NOW_US, 0.0, speed)), result, "{speed} rad/s");
            let mut shaken = inertial(NOW_US, None);
            shaken.acceleration.y = acceleration;
            assert_eq!(tracker.inertial(&shaken), result, "{acceleration} m/s²");
            let pushed = inertial(NOW_US, Some([0.0, acceleration]));
            assert_eq!(tracker.inertial(&pushed), result, "{acceleration} m/s²");
        }
    }
}

#[test]
fn a_range_is_understood_at_the_height_that_is_set() {
    let low = Config::calibrated(0.3);
    let mut tracker = Plane::new(low, &anchors(&CORNERS, 0.0)).expect("a room");
    tracker.set_height(1.0).expect("a height");
    hear(&mut tracker, 0, on_the_way(0));
    let position = tracker.position().expect("a position");
    assert!((position - Vector2::new(1.0, 2.0)).norm() < 0.01, "{position}");
    assert_eq!(tracker.set_height(f64::NAN), Err(Error::NotFinite));
}

#[test]
fn anchors_begin_with_the_same_noise() {
    let tracker = Plane::new(Config::calibrated(1.0), &anchors(&CORNERS, 0.0)).expect("a room");
    for anchor in 0..4 {
        assert!((tracker.range_sigma(anchor).expect("an anchor") - 0.1).abs() < 1e-9);
    }
    assert_eq!(tracker.range_sigma(4), None);
}

/// Whether an odometry sample affects a range that arrives this much later (µs).
fn is_used(speed: f64, turn_rate: f64, later_us: u64) -> bool {
    let mut without = following(Config::calibrated(1.0));
    let mut with = without.clone();
    with.odometry(&wheels(NOW_US, speed, turn_rate)).expect("wheels");
    for tracker in [&mut without, &mut with] {
        hear(tracker, NOW_US + later_us, on_the_way(NOW_US + later_us));
    }
    with.estimate() != without.estimate()
}

#[test]
fn wheels_are_used_for_half_a_second_while_they_drive_straight_on() {
    assert!(is_used(0.6, 0.0, 500_000) && !is_used(0.6, 0.0, 500_001));
    for sign in [1.0, -1.0] {
        assert!(is_used(0.6, sign * 0.29, 100_000) && !is_used(0.6, sign * 0.31, 100_000));
    }
}

#[test]
fn wheels_stand_that_neither_drive_nor_turn() {
    let mut tracker = following(Config::calibrated(1.0));
    for (speed, turn_rate, stands) in
        [(0.0, 0.0, true), (0.01, 0.0, false), (0.0, 0.01, false), (0.01, 0.01, false)]
    {
        tracker.odometry(&wheels(NOW_US, speed, turn_rate)).expect("wheels");
        assert_eq!(tracker.health(NOW_US).still, stands, "{speed} m/s, {turn_rate} rad/s");
    }
    tracker.odometry(&wheels(NOW_US, 0.0, 0.0)).expect("wheels");
    assert!(tracker.health(NOW_US + 500_000).still && !tracker.health(NOW_US + 500_001).still);
}

#[test]
fn a_position_that_ranges_contradict_is_counted_out_and_given_up() {
    let mut tracker = following(Config::calibrated(1.0));
    let (mut rejected, mut lost) = (0, false);
    // It was carried away by five metres.
    for step in 1..=3 {
        let time_us = NOW_US + 100_000 * step;
        for (anchor, &place) in CORNERS.iter().enumerate() {
            let range = distance(place, [6.0, 5.0, 1.0]);
            let report = tracker.range(&sample(time_us, anchor, range)).expect("a range");
            rejected += u32::from(report.outcome == Outcome::Rejected);
            let health = tracker.health(time_us);
            assert_eq!(health.rejected, rejected);
            lost |= health.state == State::Lost;
        }
    }
    assert!(rejected > 3 && lost, "{rejected}");
}

#[test]
fn a_position_is_given_up_after_a_minute_without_a_sample() {
    // Without motion, so that the position does not become useless before.
    let config = Config { acceleration_density: 0.0, ..Config::calibrated(1.0) };
    for (gap_us, state) in [(60_000_000, State::Tracking), (60_000_001, State::Lost)] {
        let mut tracker = following(config);
        let time_us = NOW_US + gap_us;
        let _ = tracker.range(&sample(time_us, 0, 3.0)).expect("a range");
        assert_eq!(tracker.health(time_us).state, state, "{gap_us} µs");
        assert_eq!(tracker.velocity().is_some(), state == State::Tracking);
    }
}

#[test]
fn a_position_is_given_up_beyond_two_metres() {
    let mut tracker = following(Config::calibrated(1.0));
    let mut last = 0.0;
    // It is shaken, and no range arrives.
    for step in 1..300 {
        let time_us = NOW_US + 100_000 * step;
        let Some(sigma) = tracker.health(time_us - 100_000).position_sigma else { break };
        last = sigma;
        let mut shaken = inertial(time_us, None);
        shaken.acceleration.y = if step % 2 == 0 { 1.0 } else { -1.0 };
        tracker.inertial(&shaken).expect("a sample");
    }
    assert!(tracker.position().is_none());
    // For each of two coordinates.
    let most = 2.0 * 2_f64.sqrt();
    assert!((0.9 * most..=most).contains(&last), "{last}");
}

#[test]
fn a_position_of_which_nothing_was_heard_since_is_worse_each_second() {
    let mut tracker = following(Config::calibrated(1.0));
    let health = |seconds: u64| tracker.health(NOW_US + 1_000_000 * seconds);
    let sigmas = [0, 1, 2].map(|seconds| health(seconds).position_sigma.expect("a position"));
    assert!(sigmas[1] > 2.0 * sigmas[0] && sigmas[2] > 1.5 * sigmas[1], "{sigmas:?}");
    // As if a sample said so.
    let later = health(2);
    assert_eq!((later.state, health(3600).state), (State::Coasting, State::Lost));
    assert_eq!(health(3600).position_sigma, None);
    tracker.inertial(&inertial(NOW_US + 2_000_000, None)).expect("a sample");
    let told = tracker.health(NOW_US + 2_000_000).position_sigma.expect("a position");
    // The position itself has gone on.
    assert!((0.7..=1.0).contains(&(told / sigmas[2])), "{told} {sigmas:?}");
}

#[test]
fn a_first_position_does_not_begin_with_an_anchor_that_is_asked_twice() {
    let mut tracker = Plane::new(Config::calibrated(1.0), &anchors(&CORNERS, 0.0)).expect("a room");
    // The fourth anchor is silent. From the seventh range on a position is searched for, a few steps with each range.
    let anchors = [0, 0, 1, 1, 2, 2].into_iter().cycle();
    let started = anchors.enumerate().take(20).position(|(step, anchor)| {
        let range = distance(CORNERS[anchor], on_the_way(0));
        let report = tracker.range(&sample(10_000 * step as u64, anchor, range)).expect("a range");
        report.outcome == Outcome::Started
    });
    assert!(started.is_some_and(|step| (6..12).contains(&step)), "{started:?}");
}

#[test]
fn an_estimate_follows_the_imu_in_steps_of_a_tenth_of_a_second() {
    let mut tracker = following(Config::calibrated(1.0));
    let before = *tracker.estimate().expect("a position");
    tracker.inertial(&inertial(NOW_US + 99_999, None)).expect("a sample");
    assert_eq!(tracker.estimate(), Some(&before));
    tracker.inertial(&inertial(NOW_US + 100_000, None)).expect("a sample");
    assert_ne!(tracker.estimate(), Some(&before));
    // A push drives it immediately.
    let before = *tracker.estimate().expect("a position");
    tracker.inertial(&inertial(NOW_US + 100_001, Some([1.0; 2]))).expect("a sample");
    assert_ne!(tracker.estimate(), Some(&before));
}

#[test]
fn what_stays_where_a_tag_stands_depends_on_its_speed() {
    // Nothing is learnt, so that all anchors are equal.
    let config = Config { learning: None, ..Config::calibrated(1.0) };
    for speed in [0.05, 0.2] {
        let mut tracker = Plane::new(config, &anchors(&CORNERS, 0.0)).expect("a room");
        for step in 0..300 {
            let x = 1.0 + 0.1 * speed * f64::from(step);
            hear(&mut tracker, 100_000 * u64::try_from(step).expect("a step"), [x, 2.0, 1.0]);
        }
        let health = tracker.health(29_900_000);
        let square = tracker.velocity().expect("a velocity").norm_squared();
        let expected = 0.05 * (1.0 + 0.01 / (0.01 + square)).sqrt();
        let found = health.bias_sigma / health.dilution.expect("four anchors");
        assert!((found - expected).abs() < 1e-6, "{speed}: {found} {expected}");
    }
}

#[test]
fn a_larger_place_is_given_up_later() {
    let corners = CORNERS.map(|[x, y, z]| [10.0 * x, 10.0 * y, z]);
    let mut tracker =
        Plane::new(Config::calibrated(1.0), &anchors(&corners, 0.0)).expect("a field");
    for time_us in (0..=NOW_US).step_by(100_000) {
        for (anchor, &place) in corners.iter().enumerate() {
            let range = distance(place, on_the_way(time_us));
            tracker.range(&sample(time_us, anchor, range)).expect("a range");
        }
    }
    let mut last = 0.0;
    for step in 1..3000 {
        let time_us = NOW_US + 100_000 * step;
        let Some(sigma) = tracker.health(time_us - 100_000).position_sigma else { break };
        last = sigma;
        let mut shaken = inertial(time_us, None);
        shaken.acceleration.y = if step % 2 == 0 { 1.0 } else { -1.0 };
        tracker.inertial(&shaken).expect("a sample");
    }
    // 50 m from the centre to the anchors: 8.3 offices.
    let most = 2.0 * 50.0 / 6.0 * 2_f64.sqrt();
    assert!((0.9 * most..=1.05 * most).contains(&last), "{last} {most}");
}

#[test]
fn a_range_of_which_fixed_point_makes_nothing_changes_nothing() {
    let number = Q12_20::from_f64;
    let corners = anchors::<Q12_20>(&CORNERS, 0.0);
    // With a known acceleration: otherwise it would be lost at such a speed.
    let config = Config { acceleration_density: Q12_20::ZERO, ..Config::plain(Q12_20::ONE) };
    let mut tracker = CalibratedPlaneTracker::<Q12_20, 4>::new(config, &corners).expect("a room");
    for (anchor, &place) in CORNERS.iter().enumerate() {
        tracker.range(&sample(0, anchor, distance(place, [3.0, 2.0, 1.0]))).expect("a range");
    }
    // According to its IMU it is 1.6 km away along both axes: 2.3 km, out of the number range.
    for step in 1..=26_u64 {
        let acceleration = Vector3::from([number(0.0), number(0.0), number(9.8)]);
        let push = Some([number(490.0); 2]);
        let sample = InertialSample { time_us: 100_000 * step, acceleration, push };
        tracker.inertial(&sample).expect("a sample");
    }
    let before = format!("{tracker:?}");
    let range = RangeSample { time_us: 2_610_000, anchor: 0, range: number(-1.0) };
    assert!(matches!(tracker.range(&range), Err(Error::Estimate(_))), "{before}");
    assert_eq!(format!("{tracker:?}"), before);
}
