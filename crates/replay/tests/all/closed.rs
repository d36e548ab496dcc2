//! Rounds that end where they began.

use kestirim_replay::pedestrian::{SensorClass, Stride, TrackPoint, Walk};
use rand_distr::{Distribution, StandardNormal};

/// The distance within which people put a foot back, m.
const PUT_BACK: f64 = 0.1;

/// A round of 120 strides, one per second and 0.8 m long, with a heading drift, a scale error and a rising height.
fn round(rate: f64, scale: f64, rise: f64) -> Walk {
    let mut walk = Walk { sensor: SensorClass::Industrial, ..Walk::default() };
    walk.track.push(TrackPoint { time_us: 0, position: [0.0; 3] });
    let mut at = [0.0; 3];
    for k in 1..=120_u32 {
        let heading = std::f64::consts::TAU * f64::from(k) / 120.0 + rate * f64::from(k);
        let length_m = 0.8 * (1.0 + scale);
        at = [at[0] + length_m * heading.cos(), at[1] + length_m * heading.sin(), at[2] + rise];
        let time_us = u64::from(k) * 1_000_000;
        walk.track.push(TrackPoint { time_us, position: at });
        walk.strides.push(Stride {
            time_us,
            position: at,
            length_m,
            duration_s: 1.0,
            heading_change_rad: std::f64::consts::TAU / 120.0 + rate,
            unseen_s: 0.0,
            bridged_rad: 0.0,
            gravity_off: 0.0,
            sigma_m: [9.0; 3],
        });
    }
    walk.path_length_m = 96.0 * (1.0 + scale);
    walk
}

#[test]
fn drift_and_rise_of_a_round_are_taken_back() {
    let (truth, mut walk) = (round(0.0, 0.0, 0.0), round(0.0008, 0.0, 0.01));
    let off = |walk: &Walk| {
        let distance = |(a, b): (&Stride, &Stride)| {
            let [dx, dy, dz] = [0, 1, 2].map(|axis| a.position[axis] - b.position[axis]);
            dx.hypot(dy).hypot(dz)
        };
        walk.strides.iter().zip(&truth.strides).map(distance).fold(0.0, f64::max)
    };
    let before = off(&walk);
    walk.close().expect("a closed walk");
    assert!(walk.closure_m < 0.1 && walk.gap_m.is_some_and(|gap| gap > 0.5), "{walk:?}");
    let rate = walk.heading_rate.expect("a rate");
    assert!((rate / 0.0008 - 1.0).abs() < 0.25, "{rate} rad/s");
    let after = off(&walk);
    assert!(after < 0.35 * before, "{after} m instead of {before} m");
    // The track goes through its strides.
    for (point, stride) in walk.track.iter().skip(1).zip(&walk.strides) {
        for axis in 0..3 {
            assert!((point.position[axis] - stride.position[axis]).abs() < 1e-9);
        }
    }
    // It is least certain half way, and at the end no worse than people's accuracy in stopping there.
    let sigma = |index: usize| walk.strides[index].sigma_m;
    let [x, y, z] = sigma(119);
    assert!(x <= PUT_BACK && y <= PUT_BACK && z <= PUT_BACK, "{:?}", sigma(119));
    assert!(sigma(60)[0].hypot(sigma(60)[1]) > x.hypot(y), "{:?}", sigma(60));
    assert!(sigma(60)[0] < 0.5, "{:?}", sigma(60));
}

#[test]
fn of_a_closed_path_that_was_not_seen_as_a_whole_the_end_alone_is_known_better() {
    let mut walk = round(0.0, 0.0, 0.0);
    walk.strides[40].unseen_s = 0.2;
    walk.close().expect("a closed walk");
    assert_eq!(walk.strides[60].sigma_m, [9.0; 3]);
    assert!(walk.strides[119].sigma_m[0] <= PUT_BACK, "{:?}", walk.strides[119]);
    // Rows of the stride with the gap have the deviations of its end.
    walk.strides[39].sigma_m = [1.0; 3];
    let sigmas: Vec<_> = walk.sigmas_m([39_500_000, 40_000_000, 40_500_000].into_iter()).collect();
    assert_eq!(sigmas, [[9.0; 3]; 3]);
    walk.strides[40].unseen_s = 0.0;
    let sigmas: Vec<_> = walk.sigmas_m([40_000_000, 40_500_000, 41_000_000].into_iter()).collect();
    assert_eq!(sigmas, [[1.0; 3], [1.0; 3], [9.0; 3]]);
}

#[test]
fn a_closed_path_stays_and_an_open_one_is_refused() {
    let mut walk = round(0.0, 0.0, 0.0);
    let before = walk.track.clone();
    walk.close().expect("a closed walk");
    for (now, before) in walk.track.iter().zip(&before) {
        assert!((now.position[0] - before.position[0]).abs() < 1e-6);
    }
    // Half of the round.
    let mut open = round(0.0, 0.0, 0.0);
    open.strides.truncate(60);
    open.track.truncate(61);
    let before = open.clone();
    let refused = open.close().expect_err("an open path");
    assert!(refused.contains("30.5") || refused.contains("30.6"), "{refused}");
    assert_eq!(open, before);
    // A round that ends two storeys higher; on level ground heights drift by a metre and a half.
    assert!(round(0.0, 0.0, 0.015).close().is_ok());
    assert!(round(0.0, 0.0, 0.06).close().is_err_and(|refused| refused.contains("+7.20 m above")));
    // A walk without strides.
    assert!(Walk::default().close().is_err());
}

#[test]
fn a_pause_turns_nothing_and_a_foot_moves_only_as_it_moves() {
    // Four samples per stride, the last two at rest; five minutes' rest half way; a heading drift.
    let (mut walk, mut at, mut time_us) = (round(0.0, 0.0, 0.0), [0.0; 3], 0);
    walk.track.truncate(1);
    for (index, stride) in walk.strides.iter_mut().enumerate() {
        for sample in 0..4 {
            time_us += if index == 60 && sample == 3 { 300_000_000 } else { 250_000 };
            if sample < 2 {
                let heading = std::f64::consts::TAU * (index + 1) as f64 / 120.0;
                let heading = heading + 0.0004 * time_us as f64 * 1e-6;
                at = [at[0] + 0.4 * heading.cos(), at[1] + 0.4 * heading.sin(), 0.0];
            }
            walk.track.push(TrackPoint { time_us, position: at });
        }
        (stride.time_us, stride.position) = (time_us, at);
    }
    walk.close().expect("a closed walk");
    let rate = walk.heading_rate.expect("a rate");
    assert!((rate / 0.0004 - 1.0).abs() < 0.1, "{rate} rad/s");
    assert!(walk.closure_m < 0.05, "{} m", walk.closure_m);
    for samples in walk.track[1..].chunks(4) {
        assert_eq!([samples[1].position; 2], [samples[2].position, samples[3].position]);
    }
}

#[test]
fn remaining_deviations_are_those_of_many_walks() {
    // A drift and errors of strides drawn three hundred times from their assumed distributions.
    use rand_xoshiro::Xoshiro256PlusPlus;
    use rand_xoshiro::rand_core::SeedableRng;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
    let truth = round(0.0, 0.0, 0.0);
    let (mut squares, mut expected) = (0.0, 0.0);
    for _ in 0..300 {
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let mut walk = round(0.00048 * normal(), 0.005 * normal(), 0.0);
        let mut own = [0.0; 2];
        for (index, stride) in walk.strides.iter_mut().enumerate() {
            for axis in 0..2 {
                own[axis] += 0.028 * normal();
                stride.position[axis] += own[axis];
            }
            walk.track[index + 1].position = stride.position;
        }
        if walk.close().is_err() {
            continue;
        }
        let (ours, true_place) = (&walk.strides[60], &truth.strides[60]);
        let [dx, dy] = [0, 1].map(|axis| ours.position[axis] - true_place.position[axis]);
        squares += dx * dx + dy * dy;
        expected += ours.sigma_m[0].powi(2) + ours.sigma_m[1].powi(2);
    }
    let ratio = (squares / expected).sqrt();
    assert!((0.85..1.15).contains(&ratio), "error over standard deviation {ratio}");
}
