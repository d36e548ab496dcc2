//! Both feet of a walk.

use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

use nalgebra::{Rotation2, Vector2};

use kestirim_pedestrian::PathUncertainty;
use kestirim_replay::pedestrian::{SensorClass, Stride, TrackPoint, Walk};

/// The number of steps of both feet, one per second, each a stride of 1.3 m.
const STEPS: u32 = 160;

/// The errors of a foot's path.
#[derive(Default)]
struct Wrong {
    rate: f64,
    scale: f64,
    /// Draws of a normal distribution for each stride's own error, if there is one.
    noise: Option<Xoshiro256PlusPlus>,
}

/// A foot of a walk along a winding way, 10 cm to the side of it: the left foot moves in even seconds, the right foot
/// in odd ones. Its frame begins at its first position and is turned by `frame` to the left.
fn foot(is_left: bool, frame: f64, mut wrong: Wrong) -> Walk {
    let heading = |step: u32| 1.2 * (f64::from(step) / 17.0).sin();
    let side = if is_left { 0.1 } else { -0.1 };
    let (mut body, mut place, mut first) = (Vector2::zeros(), Vector2::zeros(), None);
    let mut walk = Walk { sensor: SensorClass::Consumer, ..Walk::default() };
    let mut own = Vector2::zeros();
    let mut error = Vector2::zeros();
    for step in 0..=STEPS {
        let ahead = Vector2::new(heading(step).cos(), heading(step).sin());
        let moves = step > 0 && step.is_multiple_of(2) == is_left;
        if step > 0 {
            body += 0.65 * ahead;
        }
        let target = body + side * Vector2::new(-ahead.y, ahead.x);
        let start = *first.get_or_insert(target);
        let from = place;
        if moves {
            let turn = Rotation2::new(wrong.rate * f64::from(step) - frame);
            let before: Vector2<f64> = own;
            own = target - start;
            error += turn * (own - before) * (1.0 + wrong.scale);
            if let Some(rng) = &mut wrong.noise {
                let mut normal = || -> f64 { StandardNormal.sample(&mut *rng) };
                error += 0.028 * Vector2::new(normal(), normal());
            }
            place = error;
        }
        // The foot moves in the first half of its second.
        for quarter in 1..=4_u32 {
            let share = f64::from(quarter.min(2)) / 2.0;
            let at = from + share * (place - from);
            let time_us = u64::from(4 * step + quarter) * 250_000;
            walk.track.push(TrackPoint { time_us, position: [at.x, at.y, 0.0] });
        }
        if moves {
            // The foot stands until it moves again.
            let time_us = u64::from(4 * (step + 1)) * 250_000 + 1_000_000;
            walk.strides.push(Stride {
                time_us,
                position: [place.x, place.y, 0.0],
                length_m: (place - from).norm(),
                duration_s: 2.0,
                heading_change_rad: 0.0,
                unseen_s: 0.0,
                bridged_rad: 0.0,
                gravity_off: 0.0,
                sigma_m: [9.0; 3],
            });
        }
    }
    walk
}

/// The mean square of the errors of footprints, m².
fn squares(walk: &Walk, truth: &Walk) -> f64 {
    let pairs = walk.strides.iter().zip(&truth.strides);
    let off = |(a, b): (&Stride, &Stride)| {
        (a.position[0] - b.position[0]).powi(2) + (a.position[1] - b.position[1]).powi(2)
    };
    pairs.map(off).sum::<f64>() / walk.strides.len() as f64
}

#[test]
fn opposite_drifts_are_taken_back_in_any_frame() {
    let truth = foot(true, 0.0, Wrong::default());
    for frame in [0.0, 2.5, -1.0] {
        let (mut left, right) = (
            foot(true, 0.0, Wrong { rate: 0.002, ..Wrong::default() }),
            foot(false, frame, Wrong { rate: -0.002, ..Wrong::default() }),
        );
        let before = squares(&left, &truth).sqrt();
        let feet = left.join_other_foot(&right).expect("two feet");
        assert!((150..=160).contains(&feet.meetings), "{feet:?}");
        assert!((0.15..0.22).contains(&feet.distance_m), "{feet:?}");
        let rate = left.heading_rate.expect("a rate");
        assert!((rate - 0.002).abs() < 0.3 * feet.rate_sigma, "{rate} rad/s, {feet:?}");
        let after = squares(&left, &truth).sqrt();
        assert!(before > 3.0 && after < 0.1 * before, "{after} m instead of {before} m");
        assert_eq!(left.both_feet, Some(feet));
    }
}

#[test]
fn deviations_that_remain_are_those_of_many_walks() {
    let truth = foot(true, 0.0, Wrong::default());
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let (mut alone, mut together, mut expected, mut rates, mut rate_variances) =
        (0.0, 0.0, 0.0, 0.0, 0.0);
    for seed in 0..100 {
        let mut wrong = |seed| {
            let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
            let noise = Some(Xoshiro256PlusPlus::seed_from_u64(seed));
            Wrong { rate: 0.002 * normal(), scale: 0.01 * normal(), noise }
        };
        let (own, others) = (wrong(2 * seed), wrong(2 * seed + 1));
        let rate = own.rate;
        let (mut left, right) = (foot(true, 0.0, own), foot(false, 1.0, others));
        alone += squares(&left, &truth);
        let feet = left.join_other_foot(&right).expect("two feet");
        together += squares(&left, &truth);
        let variance = |stride: &Stride| stride.sigma_m[0].powi(2) + stride.sigma_m[1].powi(2);
        let all: f64 = left.strides.iter().map(variance).sum();
        expected += all / left.strides.len() as f64;
        rates += (left.heading_rate.expect("a rate") - rate).powi(2);
        rate_variances += feet.rate_sigma.powi(2);
    }
    let (gain, ratio) = ((together / alone).sqrt(), (together / expected).sqrt());
    println!("errors are {gain:.2} of those of one foot, {ratio:.2} of their deviations");
    assert!((0.55..0.8).contains(&gain), "{gain}");
    assert!((0.85..1.15).contains(&ratio), "error over standard deviation {ratio}");
    let ratio = (rates / rate_variances).sqrt();
    assert!((0.85..1.15).contains(&ratio), "error of the rate over its standard deviation {ratio}");
}

#[test]
fn what_is_no_other_foot_is_refused() {
    let left = foot(true, 0.0, Wrong::default());
    let refused = |other: &Walk| {
        let mut walk = left.clone();
        let refused = walk.join_other_foot(other).expect_err("no other foot");
        assert_eq!(walk, left);
        refused
    };
    assert!(refused(&left).contains("is that of this one"), "{}", refused(&left));
    // A foot whose clock is a step late: both move at once, and stand elsewhere.
    let mut late = foot(false, 0.0, Wrong::default());
    late.track.iter_mut().for_each(|point| point.time_us += 1_000_000);
    late.strides.iter_mut().for_each(|stride| stride.time_us += 1_000_000);
    assert!(refused(&late).contains("m apart"), "{}", refused(&late));
    // Another walk: as long, and turning where this one does not.
    let bend = Wrong { rate: 0.05, ..Wrong::default() };
    let of_another = refused(&foot(false, 0.0, bend));
    assert!(of_another.contains("m apart") || of_another.contains("no solution"), "{of_another}");
    assert!(refused(&Walk::default()).contains(": 0 times"));
    assert!(Walk::default().join_other_foot(&left).is_err());
}

#[test]
fn a_second_sensor_on_the_same_foot_is_as_good() {
    let truth = foot(true, 0.0, Wrong::default());
    let mut left = foot(true, 0.0, Wrong { rate: 0.002, ..Wrong::default() });
    let second = foot(true, 1.5, Wrong { rate: -0.002, ..Wrong::default() });
    let feet = left.join_other_foot(&second).expect("two sensors");
    assert!((78..=80).contains(&feet.meetings) && feet.distance_m < 0.1, "{feet:?}");
    assert!(squares(&left, &truth).sqrt() < 0.3, "{} m", squares(&left, &truth).sqrt());
}

#[test]
fn errors_of_strides_are_shared_and_scales_evened() {
    let (mut alone, mut together, mut expected) = (0.0, 0.0, 0.0);
    let truth = foot(true, 0.0, Wrong::default());
    for seed in 0..100 {
        let noisy = |is_left, seed| {
            let noise = Some(Xoshiro256PlusPlus::seed_from_u64(seed));
            let mut walk = foot(is_left, 0.0, Wrong { noise, ..Wrong::default() });
            // A sensor that drifts little.
            walk.sensor = SensorClass::Industrial;
            walk
        };
        let (mut left, right) = (noisy(true, 2 * seed), noisy(false, 2 * seed + 1));
        alone += squares(&left, &truth);
        let feet = left.join_other_foot(&right).expect("two feet");
        assert!((0.7..0.9).contains(&(feet.stride_sigma / 0.028)), "{feet:?}");
        together += squares(&left, &truth);
        let count = left.strides.len() as f64;
        let own = |index: usize| 2.0 * feet.stride_sigma.powi(2) * (index + 1) as f64;
        expected += (0..left.strides.len()).map(own).sum::<f64>() / count;
    }
    let (gain, ratio) = ((together / alone).sqrt(), (together / expected).sqrt());
    println!("of strides' own errors {gain:.2} is left, {ratio:.2} of their deviations");
    assert!((0.8..0.95).contains(&gain), "{gain}");
    assert!((0.85..1.15).contains(&ratio), "error over standard deviation {ratio}");
    let mut left = foot(true, 0.0, Wrong { scale: 0.01, ..Wrong::default() });
    let before = squares(&left, &truth);
    left.join_other_foot(&foot(false, 0.0, Wrong { scale: -0.01, ..Wrong::default() }))
        .expect("two");
    assert!(squares(&left, &truth) < 0.1 * before, "{} of {before} m²", squares(&left, &truth));
}

#[test]
fn strides_that_the_other_foot_did_not_see_are_as_uncertain_as_before() {
    let cut = |mut walk: Walk, steps: u64| {
        let end_us = 1_000_000 * steps;
        walk.track.retain(|point| point.time_us <= end_us);
        walk.strides.retain(|stride| stride.time_us <= end_us);
        walk
    };
    let right = foot(false, 0.0, Wrong::default());
    for (seconds, share) in [(160, 0.5..0.8), (64, 0.8..1.0)] {
        let mut left = foot(true, 0.0, Wrong { rate: 0.002, ..Wrong::default() });
        let feet = left.join_other_foot(&cut(right.clone(), seconds)).expect("two feet");
        assert!(feet.meetings > 55, "two feet and not one: {feet:?}");
        assert!(share.contains(&(feet.stride_sigma / 0.028).powi(2)), "{seconds} s: {feet:?}");
    }
}

#[test]
fn a_long_walk_with_a_large_difference_is_found() {
    // Ten times as slow, and drifting a tenth as fast: half an hour, in which the frames turn by more than half a turn.
    let left = |rate| foot(true, 0.0, Wrong { rate, ..Wrong::default() });
    let right = |rate| foot(false, 0.4, Wrong { rate, ..Wrong::default() });
    for difference in [0.02, -0.03] {
        let slow = |mut walk: Walk| {
            walk.track.iter_mut().for_each(|point| point.time_us *= 10);
            walk.strides.iter_mut().for_each(|stride| stride.time_us *= 10);
            walk
        };
        let mut own = slow(left(difference));
        own.join_other_foot(&slow(right(-difference))).expect("two feet");
        let rate = own.heading_rate.expect("a rate");
        assert!((rate - 0.1 * difference).abs() < 1e-4, "{rate} rad/s");
    }
}

#[test]
fn only_walks_that_are_not_corrected_are_joined() {
    let (mut left, mut right) =
        (foot(true, 0.0, Wrong::default()), foot(false, 0.0, Wrong::default()));
    let mut turned = left.clone();
    turned.turn_back(0.001);
    assert!(turned.join_other_foot(&right).is_err_and(|why| why.contains("magnetometer")));
    let feet = left.join_other_foot(&right).expect("two feet");
    assert!(right.join_other_foot(&left).is_err_and(|why| why.contains("joined before")));
    assert!(left.join_other_foot(&right).is_err_and(|why| why.contains("joined before")));
    // Two feet leave smaller errors than one.
    let class = kestirim_pedestrian::SensorClass::Consumer;
    assert!(feet.rate_sigma < 0.8 * class.heading_rate::<f64>(), "{feet:?}");
    assert!(feet.stride_sigma < 0.9 * PathUncertainty::<f64>::FOOTPRINT, "{feet:?}");
}
