//! The same checks in the plane and in space, with and without a common bias.

use super::wheels;
use crate::common::{anchors, distance, sample};
use kestirim_uwb_tracker::{CalibratedSpaceTracker, Config, Tracker};

/// Anchors of a room, two at the ceiling and one on the floor in the middle.
const FIVE: [[f64; 3]; 5] =
    [[0.0, 0.0, 2.5], [8.0, 0.0, 0.2], [8.0, 6.0, 2.5], [0.0, 6.0, 0.2], [4.0, 3.0, 0.0]];

/// For a stationary tag with ranges that are 20 cm too long, after five seconds in which only this many anchors are
/// heard: the initial and final standard deviations of the common bias, and the growth of the first anchor's noise.
fn heard_of<const D: usize, const N: usize>(heard: usize, range_sigma: f64) -> (f64, f64, f64) {
    let config = Config { range_sigma, ..Config::uncalibrated(1.0) };
    let mut tracker = Tracker::<f64, D, N, 5>::new(config, &anchors(&FIVE, 0.0)).expect("a room");
    let range = |place| distance(place, [3.0, 2.0, 1.0]) + 0.2;
    for (anchor, &place) in FIVE.iter().enumerate() {
        tracker.range(&sample(0, anchor, range(place))).expect("a range");
    }
    let bias = |tracker: &Tracker<f64, D, N, 5>| {
        tracker.estimate().expect("a position").covariance.variances()[N - 1].sqrt()
    };
    let (mut begun, mut noise) = (0.0, 0.0);
    for step in 1..60 {
        for (anchor, &place) in FIVE.iter().enumerate().take(heard) {
            tracker.range(&sample(100_000 * step, anchor, range(place))).expect("a range");
        }
        if step == 12 {
            // The others are no longer fresh.
            (begun, noise) = (bias(&tracker), tracker.range_sigma(0).expect("an anchor"));
        }
    }
    (begun, bias(&tracker), tracker.range_sigma(0).expect("an anchor") / noise)
}

#[test]
fn a_common_bias_is_learnt_while_two_more_anchors_are_heard_than_coordinates() {
    let is_learnt = |(begun, after, _): (f64, f64, f64)| after < begun;
    assert!(is_learnt(heard_of::<2, 5>(4, 0.1)) && !is_learnt(heard_of::<2, 5>(3, 0.1)));
    assert!(is_learnt(heard_of::<3, 7>(5, 0.1)) && !is_learnt(heard_of::<3, 7>(4, 0.1)));
}

#[test]
fn noise_is_learnt_while_one_more_anchor_is_heard_than_coordinates() {
    let is_learnt = |(_, _, change): (f64, f64, f64)| change != 1.0;
    assert!(is_learnt(heard_of::<2, 4>(3, 0.3)) && !is_learnt(heard_of::<2, 4>(2, 0.3)));
    assert!(is_learnt(heard_of::<2, 5>(3, 0.3)) && !is_learnt(heard_of::<2, 5>(2, 0.3)));
    assert!(is_learnt(heard_of::<3, 6>(4, 0.3)) && !is_learnt(heard_of::<3, 6>(3, 0.3)));
}

#[test]
fn a_doubted_standstill_is_uncertain_in_every_direction() {
    let mut tracker =
        CalibratedSpaceTracker::<f64, 5>::new(Config::calibrated(1.0), &anchors(&FIVE, 0.0))
            .expect("a room");
    let mut at_rest = None;
    for step in 0..400_u32 {
        let time_us = 100_000 * u64::from(step);
        tracker.odometry(&wheels(time_us, 0.0, 0.0)).expect("wheels");
        // After twenty seconds it is moved by one metre per second.
        let moved = 0.1 * f64::from(step.saturating_sub(200));
        for (anchor, &place) in FIVE.iter().enumerate() {
            let range = distance(place, [3.0 + moved, 2.0, 1.0]);
            tracker.range(&sample(time_us, anchor, range)).expect("a range");
        }
        let Some(estimate) = tracker.estimate() else {
            assert_eq!(step, 0, "a position after two epochs");
            continue;
        };
        let variances = estimate.covariance.variances();
        if step == 200 {
            at_rest = Some(variances);
        }
        if let Some(before) = at_rest
            && !tracker.health(time_us).still
        {
            for axis in 3..6 {
                // As at the start: half a metre per second.
                assert!(before[axis] < 0.01 && variances[axis] > 0.1, "{variances} {before}");
            }
            return;
        }
    }
    panic!("it was never doubted");
}
