//! The tracker of a robot on wheels: its two courses, what they learn, and when they are given up.

use super::*;
use crate::State;
use crate::wheels::state::GAIN;
use kestirim_adaptive_kalman::MeasurementNoise;

/// Corners of a room, with an anchor in each of the first A; multiplied by 8 they are those of a field.
const CORNERS: [[f64; 3]; 4] =
    [[-4.0, -3.0, 1.0], [4.0, -3.0, 1.0], [4.0, 3.0, 1.0], [-4.0, 3.0, 1.0]];

fn tracker<const A: usize>(size: f64) -> WheelTracker<f64, A> {
    let anchor =
        |[x, y, z]: [f64; 3]| Anchor { position: [x * size, y * size, z].into(), bias: 0.0 };
    let anchors: [Anchor<f64>; A] = core::array::from_fn(|index| anchor(CORNERS[index]));
    WheelTracker::new(Config::uncalibrated(1.0), &anchors).expect("a room")
}

fn wheels(time_us: u64, speed: f64, turn_rate: f64) -> OdometrySample<f64> {
    OdometrySample { time_us, speed, turn_rate }
}

/// Processes a range of an anchor to a tag at the anchors' height.
fn hear<const A: usize>(
    tracker: &mut WheelTracker<f64, A>,
    time_us: u64,
    anchor: usize,
    tag: [f64; 2],
) -> Result<Report<f64>, Error> {
    let place = tracker.links[anchor].anchor.position;
    let range = (place[0] - tag[0]).hypot(place[1] - tag[1]);
    tracker.range(&RangeSample { time_us, anchor, range })
}

fn hear_all<const A: usize>(tracker: &mut WheelTracker<f64, A>, time_us: u64, tag: [f64; 2]) {
    for anchor in 0..A {
        hear(tracker, time_us, anchor, tag).expect("a range");
    }
}

#[test]
fn a_start_follows_turns_to_both_sides() {
    let mut tracker = tracker::<4>(1.0);
    assert!(tracker.estimate().is_none() && tracker.scale().is_none());
    hear_all(&mut tracker, 0, [1.0, 0.5]);
    let gains = tracker.courses.map(|course| course.map(|course| course.estimate.mean[GAIN]));
    assert_eq!(gains, [Some(1.0), Some(-1.0)]);
    assert_eq!(tracker.scale(), None, "the heading is not known");
}

#[test]
fn ranges_that_are_too_short_begin_anew_and_those_that_are_too_long_do_not() {
    let mut begun = tracker::<4>(1.0);
    hear_all(&mut begun, 0, [1.0, 0.5]);
    // The average before, and how much too long a range is.
    for (before, excess, stays) in [(1.0, -1.5, true), (2.5, -1.5, false), (2.5, 1.5, true)] {
        let mut tracker = begun.clone();
        tracker.too_short = before;
        let place = tracker.links[0].anchor.position;
        let range = (place[0] - 1.0).hypot(place[1] - 0.5) + excess;
        tracker.range(&RangeSample { time_us: 100_000, anchor: 0, range }).expect("a range");
        assert_eq!(tracker.position().is_some(), stays, "{before}, {excess} m");
    }
}

#[test]
fn the_better_course_is_told_and_anchors_learn_of_it() {
    let mut begun = tracker::<4>(1.0);
    hear_all(&mut begun, 0, [1.0, 0.5]);
    let course = begun.courses[0].expect("a course");
    let at = |x: f64, cost: f64| {
        let mut course = course;
        (course.cost, course.estimate.mean[0]) = (cost, x);
        Some(course)
    };
    for (courses, x) in [
        ([at(1.0, 3.0), at(2.0, 9.0)], 1.0),
        ([at(2.0, 9.0), at(1.0, 3.0)], 1.0),
        ([None, at(1.0, 9.0)], 1.0),
        ([at(1.0, 9.0), None], 1.0),
    ] {
        let mut tracker = begun.clone();
        tracker.courses = courses;
        assert_eq!(tracker.position().expect("a position")[0], x);
        let before = tracker.links[0].noise.variance();
        let report = hear(&mut tracker, 1, 0, [1.0, 0.5]).expect("a range");
        assert!(report.innovation.expect("a course").innovation.abs() < 1e-6, "{report:?}");
        assert!(tracker.links[0].noise.variance() <= before, "it fits the better one");
    }
}

#[test]
fn an_anchors_noise_is_learnt_where_two_others_are_heard() {
    fn learns<const A: usize>(heard: usize) -> bool {
        let mut tracker = tracker::<A>(1.0);
        hear_all(&mut tracker, 0, [1.0, 0.5]);
        for step in 11..40 {
            for anchor in 0..heard {
                hear(&mut tracker, 100_000 * step, anchor, [1.0, 0.5]).expect("a range");
            }
        }
        tracker.links[0].noise = MeasurementNoise::new(1.0);
        hear(&mut tracker, 4_000_000, 0, [1.0, 0.5]).expect("a range");
        tracker.links[0].noise.variance() < 1.0
    }
    assert!(learns::<4>(4) && learns::<4>(3) && !learns::<4>(2));
}

#[test]
fn a_sample_may_be_a_tenth_of_a_second_late() {
    for (late_us, result) in [(0, Ok(())), (100_000, Ok(())), (100_001, Err(Error::OutOfOrder))] {
        let mut tracker = tracker::<4>(1.0);
        hear_all(&mut tracker, 0, [1.0, 0.5]);
        tracker.odometry(&wheels(1_000_000, 0.0, 0.0)).expect("wheels");
        let time_us = 1_000_000 - late_us;
        assert_eq!(tracker.odometry(&wheels(time_us, 0.0, 0.0)), result);
        assert_eq!(hear(&mut tracker, time_us, 0, [1.0, 0.5]).map(drop), result);
    }
}

#[test]
fn wheels_stand_that_neither_drive_nor_turn() {
    let mut tracker = tracker::<4>(1.0);
    hear_all(&mut tracker, 0, [1.0, 0.5]);
    for (speed, turn_rate, stands) in
        [(0.0, 0.0, true), (0.01, 0.0, false), (0.0, 0.01, false), (0.01, 0.01, false)]
    {
        tracker.odometry(&wheels(1000, speed, turn_rate)).expect("wheels");
        assert_eq!(tracker.health(1000).still, stands, "{speed} m/s, {turn_rate} rad/s");
    }
    tracker.odometry(&wheels(1000, 0.0, 0.0)).expect("wheels");
    assert!(tracker.health(2_001_000).still && !tracker.health(2_001_001).still);
}

#[test]
fn a_position_is_as_uncertain_as_both_coordinates_and_what_stays_at_its_speed() {
    for (counted, scale) in [(0.0, 2.0), (0.05, 2.0), (0.05, 1.0), (0.4, 1.0)] {
        let mut tracker = tracker::<4>(1.0);
        hear_all(&mut tracker, 0, [1.0, 0.5]);
        tracker.odometry(&wheels(1, counted, 0.0)).expect("wheels");
        let course = tracker.courses[0].as_mut().expect("a course");
        (course.estimate.mean[COSINE], course.estimate.mean[SINE]) = (0.6 * scale, 0.8 * scale);
        let variances = course.estimate.covariance.variances();
        let health = tracker.health(1);
        let own = variances[0] + variances[1];
        let bias = health.bias_sigma;
        let sigma = health.position_sigma.expect("a position");
        assert!((sigma * sigma - own - bias * bias).abs() < 1e-9, "{health:?}");
        // 10 cm each, and as much again while it stands; all anchors are equal.
        let speed = counted * scale;
        let stands = 0.01 / (0.01 + speed * speed);
        let expected = 0.1 * (1.0 + stands).sqrt() * health.dilution.expect("four anchors");
        assert!((bias - expected).abs() < 1e-6, "{counted} {scale}: {bias} {expected}");
        assert!((tracker.scale().expect("a heading") - scale).abs() < 1e-9);
    }
}

/// State of a tracker in a field with a diagonal of 80 m, after gaps (µs) between ranges; the robot last drove at 1 m/s.
fn after_gaps<const K: usize>(gaps_us: [u64; K]) -> State {
    let mut tracker = tracker::<4>(8.0);
    tracker.odometry(&wheels(0, 1.0, 0.0)).expect("wheels");
    hear_all(&mut tracker, 0, [8.0, 4.0]);
    hear_all(&mut tracker, 1, [8.0, 4.0]);
    let mut time_us = 1;
    for gap_us in gaps_us {
        time_us += gap_us;
        hear(&mut tracker, time_us, 0, [8.0, 4.0]).expect("a range");
    }
    tracker.health(time_us).state
}

#[test]
fn a_position_is_given_up_after_a_minute_or_when_it_is_worthless() {
    // It keeps a direction for two seconds at 1 m/s, and is random beyond: 120 m² after a minute. With the size of 6.7
    // offices, up to (13.3 m)², 178 m², are useful.
    assert_eq!(after_gaps([60_000_000]), State::Tracking);
    assert_eq!(after_gaps([60_000_001]), State::Lost);
    assert_eq!(after_gaps([50_000_000, 30_000_000]), State::Tracking);
    assert_eq!(after_gaps([55_000_000, 59_000_000]), State::Lost);
}

#[test]
fn a_first_position_waits_for_all_anchors_or_one_of_them_again() {
    let mut tracker = tracker::<4>(1.0);
    // Some radios poll each anchor twice; the fourth is silent.
    for (time_us, anchor) in
        [(0, 0), (10_000, 0), (20_000, 1), (30_000, 2), (40_000, 2), (50_000, 0)]
    {
        let report = hear(&mut tracker, time_us, anchor, [1.0, 0.5]).expect("a range");
        assert_eq!(report.outcome, Outcome::Collected, "{time_us}");
        assert_eq!(tracker.start.is_on(), time_us == 50_000, "{time_us}");
    }
    // The position from three anchors is searched for from all starts, over a few ranges.
    let mut later = (6..20_u64).map(|k| {
        let report = hear(&mut tracker, 10_000 * k, k as usize % 3, [1.0, 0.5]);
        report.expect("a range").outcome
    });
    let started = later.position(|outcome| outcome == Outcome::Started);
    assert!(started.is_some_and(|ranges| ranges < 6), "{started:?}");
}

#[test]
fn a_height_is_a_number() {
    let mut tracker = tracker::<4>(1.0);
    assert_eq!(tracker.set_height(f64::NAN), Err(Error::NotFinite));
    assert_eq!(tracker.config.height, 1.0);
    assert_eq!(tracker.set_height(0.4), Ok(()));
    assert_eq!(tracker.config.height, 0.4);
}

#[test]
fn what_leaves_the_room_is_given_up() {
    let mut begun = tracker::<4>(1.0);
    begun.config.room = Some(kestirim_uwb_ranging::Room::plane(-5.0, -4.0, 5.0, 4.0));
    hear_all(&mut begun, 0, [1.0, 0.5]);
    let course = begun.courses[0].expect("a course");
    let at = |y: f64| {
        let mut course = course;
        course.estimate.mean[1] = y;
        Some(course)
    };
    let sigma = (course.estimate.covariance.get(0, 0).unwrap()
        + course.estimate.covariance.get(1, 1).unwrap())
    .sqrt();
    let (inside, outside) = (4.4 + 3.0 * sigma, 4.6 + 3.0 * sigma);
    let room = begun.config.room.expect("a room");
    let left = |courses| within(courses, &room).map(|course| course.is_some());
    assert_eq!(left([at(inside), at(outside)]), [true, false]);
    assert_eq!(left([None, at(-outside)]), [false, false]);
    // A range that is consistent with the position outside does not keep it.
    begun.courses = [None, at(-outside)];
    hear(&mut begun, 1, 0, [1.0, -outside]).expect("a range");
    assert!(begun.position().is_none());
}
