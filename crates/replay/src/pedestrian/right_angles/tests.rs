use super::*;
use crate::pedestrian::{SensorClass, Stride, TrackPoint};
use rand_distr::{Distribution, Normal, Uniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// A drift of two standard deviations of the class, rad/s.
const DRIFT: f64 = 0.004;

/// Legs of so many strides in these directions, degrees; a stride a second, 1.2 m long, on a heading that drifts.
fn walk(legs: &[(u32, f64)], drift: f64) -> Walk {
    let mut walk = Walk { sensor: SensorClass::Consumer, ..Walk::default() };
    walk.track.push(TrackPoint { time_us: 0, position: [0.0; 3] });
    let (mut at, mut seconds) = ([0.0; 3], 0_u32);
    for (strides, direction) in legs {
        for _ in 0..*strides {
            let heading = direction.to_radians() + drift * (f64::from(seconds) + 0.5);
            at = [at[0] + 1.2 * heading.cos(), at[1] + 1.2 * heading.sin(), 0.0];
            seconds += 1;
            let time_us = u64::from(seconds) * 1_000_000;
            walk.track.push(TrackPoint { time_us, position: at });
            walk.strides.push(Stride {
                time_us,
                position: at,
                length_m: 1.2,
                duration_s: 1.0,
                heading_change_rad: 0.0,
                sigma_m: [0.0; 3],
            });
        }
    }
    walk
}

/// The largest error of a footprint, m.
fn off(walk: &Walk, truth: &Walk) -> f64 {
    let pairs = walk.strides.iter().zip(&truth.strides);
    pairs
        .map(|(a, b)| (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1]))
        .fold(0.0, f64::max)
}

/// Corridors, once around and half way again, and a hall that is crossed.
const BUILDING: [(u32, f64); 7] =
    [(12, 20.0), (9, 110.0), (4, 155.0), (12, 200.0), (9, 290.0), (12, 20.0), (9, 110.0)];

#[test]
fn a_drift_in_a_building_is_taken_back() {
    let (truth, mut found) = (walk(&BUILDING, 0.0), walk(&BUILDING, DRIFT));
    let before = off(&found, &truth);
    let angles = found.align_to_right_angles().expect("a building");
    let rate = found.heading_rate.expect("a rate");
    assert!((rate - DRIFT).abs() < 2.0 * angles.rate_sigma, "{rate} ± {}", angles.rate_sigma);
    assert!(angles.rate_sigma < 0.0006, "{}", angles.rate_sigma);
    assert!((angles.share - 63.0 / 67.0).abs() < 1e-9, "{}", angles.share);
    let after = off(&found, &truth);
    assert!(before > 2.0 && after < 0.15 * before, "{after} m instead of {before} m");
}

#[test]
fn who_walks_elsewhere_stays() {
    let triangle = [(12, 0.0), (12, 120.0), (12, 240.0), (12, 0.0), (12, 120.0)];
    let circle: Vec<_> = (0..90).map(|k| (1, 4.0 * f64::from(k))).collect();
    for (walked, legs) in
        [(&triangle[..], "of 72 m"), (&circle[..], "of 108 m"), (&BUILDING[..3], "of 30 m")]
    {
        let mut walk = walk(walked, 0.0);
        let before = walk.clone();
        let refused = walk.align_to_right_angles().expect_err("no building");
        assert!(refused.contains(legs) && refused.len() <= 200, "{refused}");
        assert_eq!(walk, before);
    }
    assert!(Walk::default().align_to_right_angles().is_err());
}

#[test]
fn legs_that_lead_anywhere_seldom_pass_for_a_building() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let (angle, drift) = (Uniform::new(0.0, 360.0).expect("angles"), Normal::new(0.0, 0.002));
    let drift = drift.expect("a deviation");
    let (mut passed, mut before, mut after) = (0, 0.0, 0.0);
    for round in 0..300 {
        let legs: Vec<_> = (0..4 + round % 5).map(|_| (8, angle.sample(&mut random))).collect();
        let (truth, mut found) = (walk(&legs, 0.0), walk(&legs, drift.sample(&mut random)));
        let was = off(&found, &truth);
        if found.align_to_right_angles().is_ok() {
            passed += 1;
            before += was * was;
            after += off(&found, &truth).powi(2);
        }
    }
    println!("{passed} of 300; squares of the errors {before:.1} before, {after:.1} after");
    assert!(passed <= 6, "{passed} of 300");
}

#[test]
fn rates_err_as_much_as_they_say() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let normal = |sigma| Normal::new(0.0, sigma).expect("a deviation");
    let (drift, astray) = (normal(0.002), normal(ALONG.to_degrees()));
    let errors = (0..200).map(|_| {
        let drift = drift.sample(&mut random);
        let legs = BUILDING.map(|(strides, angle)| (strides, angle + astray.sample(&mut random)));
        let mut found = walk(&legs, drift);
        let angles = found.align_to_right_angles().expect("a building");
        (found.heading_rate.expect("a rate") - drift) / angles.rate_sigma
    });
    let square = errors.map(|error| error * error).sum::<f64>() / 200.0;
    assert!((0.7..1.5).contains(&square), "{square}");
}
