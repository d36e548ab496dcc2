//! Tests with synthetic walks of known length, for every scalar, navigator and mode.

use crate::common::Foot;
use kestirim_pedestrian::{
    Config, Ekf, Estimate, ImuSample, Lite, Navigator, OfflineTracker, Stride, Tracker,
};
use kestirim_scalar::{Q12_20, Scalar};

/// The synthetic foot does not roll.
fn config<T: Scalar>() -> Config<T> {
    Config { contact_height: T::ZERO, ..Config::default() }
}

struct Walked<T: Scalar> {
    last: Estimate<T>,
    strides: Vec<Stride<T>>,
    path_length: f64,
}

fn causal<T: Scalar, N: Navigator<T>>(samples: &[ImuSample<T>]) -> Walked<T> {
    let mut tracker = Tracker::<T, N>::new(config());
    let estimates: Vec<_> = samples.iter().map(|sample| tracker.update(sample).unwrap()).collect();
    let strides = estimates.iter().filter_map(|e| e.stride).chain(tracker.finish()).collect();
    let path_length = tracker.path_length().to_f64();
    Walked { last: *estimates.last().unwrap(), strides, path_length }
}

fn offline<T: Scalar, N: Navigator<T>>(samples: &[ImuSample<T>]) -> Walked<T> {
    let mut statistic = vec![T::ZERO; samples.len()];
    let mut tracker = OfflineTracker::<T, N>::new(config(), samples, &mut statistic).unwrap();
    let estimates: Vec<_> = tracker.by_ref().collect();
    assert_eq!(estimates.len(), samples.len());
    let strides = estimates.iter().filter_map(|e| e.stride).chain(tracker.finish()).collect();
    let path_length = tracker.path_length().to_f64();
    Walked { last: *estimates.last().unwrap(), strides, path_length }
}

fn check<T: Scalar>(walked: &Walked<T>, foot: &Foot, end: [f64; 2]) {
    // The smooth swing begins and ends so slowly that a little of it counts as stance.
    let count = foot.headings.len();
    assert_eq!(walked.strides.len(), count);
    let length = foot.stride * count as f64;
    assert!(
        (walked.path_length / length - 1.0).abs() < 0.015,
        "{} of {length} m",
        walked.path_length
    );
    // The residual gyro bias turns the path.
    let tolerance = if foot.noise > 0.0 { 0.6 } else { 0.2 };
    for (position, end) in walked.last.position.iter().zip(end) {
        assert!((position.to_f64() - end).abs() < tolerance, "{position:?} instead of {end} m");
    }
    for stride in &walked.strides {
        assert!((stride.length.to_f64() / foot.stride - 1.0).abs() < 0.04, "{stride:?}");
    }
    for stride in &walked.strides[1..count - 1] {
        assert!((stride.duration.to_f64() - 1.1).abs() < 0.1, "{stride:?}");
    }
}

fn check_all<T: Scalar>(foot: &Foot, end: [f64; 2]) -> f64 {
    let samples = foot.samples::<T>();
    check(&causal::<T, Lite<T>>(&samples), foot, end);
    check(&causal::<T, Ekf<T>>(&samples), foot, end);
    check(&offline::<T, Lite<T>>(&samples), foot, end);
    let walked = offline::<T, Ekf<T>>(&samples);
    check(&walked, foot, end);
    walked.path_length
}

#[test]
fn a_straight_walk() {
    let foot = Foot::default();
    let single = check_all::<f32>(&foot, [12.0, 0.0]);
    let double = check_all::<f64>(&foot, [12.0, 0.0]);
    let fixed = check_all::<Q12_20>(&foot, [12.0, 0.0]);
    // Without noise, rates at the top of a swing are repeated in single precision, and skipped.
    assert!((single / double - 1.0).abs() < 1e-3, "{single} {double}");
    assert!((fixed / double - 1.0).abs() < 5e-3, "{fixed} {double}");
}

#[test]
fn a_walk_round_a_corner() {
    let right_angle = core::f64::consts::FRAC_PI_2;
    let mut headings = vec![0.0; 5];
    headings.extend([right_angle; 5]);
    let foot = Foot { headings, rate: 200.0, ..Foot::default() };
    check_all::<f32>(&foot, [6.0, 6.0]);
    check_all::<Q12_20>(&foot, [6.0, 6.0]);
    let walked = causal::<f64, Ekf<f64>>(&foot.samples());
    for (index, stride) in walked.strides.iter().enumerate() {
        let expected = if index == 5 { right_angle } else { 0.0 };
        assert!((stride.heading_change - expected).abs() < 0.05, "stride {index}: {stride:?}");
    }
}

#[test]
fn a_biased_and_noisy_chip_walks_as_far() {
    let bias = nalgebra::Vector3::new(0.05, -0.04, 0.06);
    let foot = Foot { bias, noise: 0.2, ..Foot::default() };
    check_all::<f32>(&foot, [12.0, 0.0]);
    check_all::<Q12_20>(&foot, [12.0, 0.0]);
}

/// Standing does not observe the heading, whose uncertainty must not overflow in the swing after it.
#[test]
fn a_walk_after_minutes_of_standing_is_as_long_in_fixed_point() {
    const STOOD_US: u64 = 330_000_000;
    let foot = Foot::default();
    let walk = foot.samples::<Q12_20>();
    let still = |time_us| ImuSample { time_us, ..walk[0] };
    let mut samples: Vec<_> = (1..=STOOD_US / 10_000).map(|step| still(10_000 * step)).collect();
    let later = |sample: &ImuSample<_>| ImuSample { time_us: sample.time_us + STOOD_US, ..*sample };
    samples.extend(walk.iter().map(later));
    check(&causal::<Q12_20, Ekf<Q12_20>>(&samples), &foot, [12.0, 0.0]);
}

/// A bus that stalls for 0.6 s delivers zeros: the walk before is unaffected, and the tracker continues.
#[test]
fn zeros_teach_nothing_and_end_nothing() {
    fn check<T: Scalar, N: Navigator<T>>(samples: &[ImuSample<T>]) {
        let mut stalled = samples.to_vec();
        let middle = stalled.len() / 2;
        for sample in &mut stalled[middle..middle + 120] {
            sample.specific_force.fill(T::ZERO);
            sample.angular_rate.fill(T::ZERO);
        }
        for walked in [causal::<T, N>(&stalled), offline::<T, N>(&stalled)] {
            let position = walked.last.position.map(T::to_f64);
            assert!(position.iter().all(|metres| metres.is_finite()), "{position:?}");
            assert!(walked.path_length.is_finite() && walked.path_length > 0.0);
        }
    }
    let foot = Foot::default();
    check::<f32, Lite<f32>>(&foot.samples());
    check::<f32, Ekf<f32>>(&foot.samples());
    check::<f64, Lite<f64>>(&foot.samples());
    check::<f64, Ekf<f64>>(&foot.samples());
    check::<Q12_20, Lite<Q12_20>>(&foot.samples());
    check::<Q12_20, Ekf<Q12_20>>(&foot.samples());
}
