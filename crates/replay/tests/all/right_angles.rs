//! Walks among walls at right angles.

use kestirim_replay::pedestrian::{SensorClass, Stride, TrackPoint, Walk};
use rand_distr::{Distribution, Normal, Uniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// Standard deviation of a leg's direction from that of the walls, rad.
const ALONG: f64 = 0.026;
/// A drift of two standard deviations of the class, rad/s.
const DRIFT: f64 = 0.004;

/// A walk of legs with these numbers of strides and directions, degrees; one stride per second, 1.2 m long, with a
/// drifting heading.
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
                unseen_s: 0.0,
                bridged_rad: 0.0,
                gravity_off: 0.0,
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

/// Corridors, once around and half way again, with a hall that is crossed.
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
fn a_round_that_is_closed_too_keeps_what_the_walls_showed() {
    let around = [(12, 20.0), (9, 110.0), (12, 200.0), (9, 290.0)];
    let twice = [around, around].concat();
    let (truth, mut found) = (walk(&twice, 0.0), walk(&twice, DRIFT));
    let angles = found.align_to_right_angles().expect("a building");
    let shown = found.heading_rate.expect("a rate");
    found.close().expect("a round");
    let rate = found.heading_rate.expect("a rate");
    assert!((rate - shown).abs() < 2.0 * angles.rate_sigma, "{rate} after {shown}");
    assert!(found.closure_m < 0.1 && off(&found, &truth) < 0.5, "{} m", off(&found, &truth));
    // The remaining error of the rate is less than that of the class.
    let mut closed = walk(&twice, DRIFT);
    closed.close().expect("a round");
    let sigma = |walk: &Walk| walk.strides[20].sigma_m[0].hypot(walk.strides[20].sigma_m[1]);
    assert!(sigma(&found) < sigma(&closed), "{} and {} m", sigma(&found), sigma(&closed));
}

#[test]
fn a_pause_turns_nothing() {
    let rest = |mut walk: Walk| {
        let rests =
            |time_us: &mut u64| *time_us += if *time_us > 21_000_000 { 300_000_000 } else { 0 };
        walk.track.iter_mut().for_each(|point| rests(&mut point.time_us));
        walk.strides.iter_mut().for_each(|stride| rests(&mut stride.time_us));
        // The foot stands where the second leg ended; that stride ends with its stance.
        let stands = TrackPoint { time_us: 321_000_000, ..walk.track[21] };
        walk.track.insert(22, stands);
        (walk.strides[20].time_us, walk.strides[20].duration_s) = (stands.time_us, 301.0);
        walk
    };
    let mut found = rest(walk(&BUILDING, 0.0));
    found.align_to_right_angles().expect("a building");
    let rate = found.heading_rate.expect("a rate");
    assert!(rate.abs() < 1e-6, "{rate}");
}

#[test]
fn who_walks_elsewhere_stays() {
    let triangle = [(12, 0.0), (12, 120.0), (12, 240.0), (12, 0.0), (12, 120.0)];
    let circle: Vec<_> = (0..90).map(|k| (1, 4.0 * f64::from(k))).collect();
    let crossed = [(12, 0.0), (12, 31.0), (12, 90.0), (12, 0.0), (12, 90.0)];
    for (walked, why) in [
        (&triangle[..], "in 2 legs"),
        (&circle[..], "of 108 m walked"),
        (
            &BUILDING[..3],
            "of 30 m walked 25 m are straight along two directions at right angles, in 2 legs;",
        ),
    ] {
        let mut found = walk(walked, 0.0);
        let before = found.clone();
        let refused = found.align_to_right_angles().expect_err("no building");
        assert!(refused.contains(why) && refused.len() <= 200, "{refused}");
        assert_eq!(found, before);
    }
    assert!(walk(&crossed, 0.0).align_to_right_angles().is_ok(), "one leg may go anywhere");
    let refused = Walk::default().align_to_right_angles().expect_err("no walk");
    assert_eq!(refused, "no right angles: there is no stride");
}

/// The number of walks, of 200 whose legs of eight strides lead in any direction, that pass; in their pauses the
/// heading drifts.
fn passing(pause_s: u32) -> u32 {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let angle = Uniform::new(0.0, 360.0).expect("angles");
    let drift = Normal::new(0.0, 0.002).expect("a deviation");
    let mut passed = 0;
    for round in 0..200 {
        let legs: Vec<_> = (0..4 + round % 5).map(|_| (8, angle.sample(&mut random))).collect();
        let mut found = walk(&legs, drift.sample(&mut random));
        let moment = |index: usize| {
            let pauses = (index.saturating_sub(1) / 8) as u64;
            1_000_000 * (index as u64 + pauses * u64::from(pause_s))
        };
        for (index, point) in found.track.iter_mut().enumerate() {
            point.time_us = moment(index);
        }
        for (index, stride) in found.strides.iter_mut().enumerate() {
            stride.time_us = moment(index + 1);
        }
        passed += u32::from(found.align_to_right_angles().is_ok());
    }
    println!("{passed} of 200 with pauses of {pause_s} s");
    passed
}

#[test]
fn legs_that_lead_anywhere_seldom_pass_for_a_building() {
    for pause_s in [0, 60, 600] {
        let passed = passing(pause_s);
        assert!(passed <= 4, "{passed} of 200 with pauses of {pause_s} s");
    }
}

#[test]
fn a_long_walk_is_no_harder() {
    // More than an hour; the last legs have turned by more than half a circle.
    let hours: Vec<_> = BUILDING.iter().cycle().take(60 * BUILDING.len()).copied().collect();
    for drift in [0.0008, -0.0031] {
        let mut found = walk(&hours, drift);
        let angles = found.align_to_right_angles().expect("a building");
        let rate = found.heading_rate.expect("a rate");
        assert!((rate - drift).abs() < 3.0 * angles.rate_sigma, "{rate} ± {}", angles.rate_sigma);
    }
}

#[test]
fn rates_err_as_much_as_they_say() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let normal = |sigma| Normal::new(0.0, sigma).expect("a deviation");
    let (drift, astray) = (normal(0.002), normal(ALONG.to_degrees()));
    let errors: Vec<f64> = (0..200)
        .filter_map(|_| {
            let drift = drift.sample(&mut random);
            let legs =
                BUILDING.map(|(strides, angle)| (strides, angle + astray.sample(&mut random)));
            let mut found = walk(&legs, drift);
            let angles = found.align_to_right_angles().ok()?;
            Some((found.heading_rate? - drift) / angles.rate_sigma)
        })
        .collect();
    // The most crooked buildings may be rejected by chance.
    let count = errors.len();
    println!("{count} of 200 buildings are found");
    assert!(count >= 190, "{count} of 200");
    let square = errors.iter().map(|error| error * error).sum::<f64>() / count as f64;
    assert!((0.7..1.5).contains(&square), "{square}");
}
