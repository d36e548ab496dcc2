//! Tests with streams as recorders deliver them: irregular, doubled, with gaps, saturated, in wrong units, broken.

use crate::common::Foot;
use kestirim_pedestrian::detector::{
    Adaptive, AngularRateEnergy, FixedShoe, Motion, MovingVariance, StanceDetector,
};
use kestirim_pedestrian::{
    Config, Ekf, EkfTracker, Error, ImuSample, Lite, LiteTracker, Navigator, OfflineTracker,
    SensorClass, Tracker, Warnings,
};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{SVector, Vector3};
use proptest::prelude::*;

fn warnings(samples: &[ImuSample<f64>]) -> Warnings {
    let mut tracker = EkfTracker::<f64>::new(Config::default());
    for sample in samples {
        tracker.update(sample).unwrap();
    }
    tracker.warnings()
}

fn changed(mut change: impl FnMut(&mut ImuSample<f64>)) -> Warnings {
    let mut samples = Foot { noise: 0.05, ..Foot::default() }.samples();
    samples.iter_mut().for_each(&mut change);
    warnings(&samples)
}

#[test]
fn a_clean_walk_raises_no_warning() {
    assert_eq!(changed(|_| {}), Warnings::default());
}

#[test]
fn what_is_wrong_with_a_stream_is_named() {
    assert!(
        changed(|s| s.specific_force = s.specific_force.map(|f| f.clamp(-19.6, 19.6)))
            .accelerometer_saturated
    );
    assert!(
        changed(|s| s.angular_rate = (s.angular_rate * 5.0).map(|w| w.clamp(-4.3, 4.3)))
            .gyroscope_saturated
    );
    assert!(changed(|s| s.specific_force /= 9.80665).gravity_implausible);
    assert!(changed(|s| s.angular_rate *= 57.3).rate_implausible);
    assert!(changed(|s| s.angular_rate = -s.angular_rate).axes_inconsistent);
    assert!(
        changed(|s| if s.time_us > 5_000_000 {
            s.time_us += 300_000;
        })
        .gaps
    );
    let never_still = Foot { headings: vec![], noise: 3.0, ..Foot::default() };
    assert!(warnings(&never_still.samples()).never_still);
}

/// A walk of twenty strides whose gyroscope clips at this rate (rad/s), with half a per cent of noise there.
fn clipped_at(end: f64) -> (Vec<ImuSample<f64>>, Foot) {
    let foot = Foot { rate: 200.0, pitch: 2.0, headings: vec![0.0; 20], ..Foot::default() };
    let mut samples = foot.samples::<f64>();
    for (k, sample) in samples.iter_mut().enumerate() {
        let noise = 1.0 + 0.005 * ((k * 379 % 1009) as f64 / 504.0 - 1.0);
        sample.angular_rate =
            sample.angular_rate.map(|w| if w.abs() > end { w.signum() * end * noise } else { w });
    }
    (samples, foot)
}

fn end_of<N: Navigator<f64>>(samples: &[ImuSample<f64>]) -> (Vector3<f64>, Warnings) {
    let mut tracker = Tracker::<f64, N>::new(Config { contact_height: 0.0, ..Config::default() });
    let mut position = Vector3::zeros();
    for sample in samples {
        position = tracker.update(sample).unwrap().position;
    }
    (position, tracker.warnings())
}

#[test]
fn a_clipped_gyroscope_is_told_and_bridged() {
    let (whole, _) = clipped_at(f64::INFINITY);
    let fastest = whole.iter().map(|s| s.angular_rate.amax()).fold(0.0, f64::max);
    for share in [0.75, 0.9] {
        let (samples, foot) = clipped_at(share * fastest);
        let truth = foot.stride * foot.headings.len() as f64;
        for (position, warnings) in [end_of::<Ekf<f64>>(&samples), end_of::<Lite<f64>>(&samples)] {
            let error = (position.x.hypot(position.y) - truth).abs();
            assert!(warnings.gyroscope_saturated && !warnings.axes_inconsistent, "{warnings:?}");
            assert!(error < 0.03 * truth, "{share}: {error} m, height {} m", position.z);
        }
    }
    assert!(!end_of::<Ekf<f64>>(&whole).1.gyroscope_saturated);
}

#[test]
fn a_gap_does_not_lose_the_walk() {
    let mut samples = Foot::default().samples::<f32>();
    samples.retain(|s| !(4_000_000..4_150_000).contains(&s.time_us));
    let mut tracker = EkfTracker::<f32>::new(Config::default());
    for sample in &samples {
        assert!(tracker.update(sample).unwrap().position.iter().all(|p| p.abs() < 30.0));
    }
    assert!((tracker.path_length() - 12.0).abs() < 2.0, "{}", tracker.path_length());
}

#[test]
fn a_row_written_twice_changes_nothing() {
    let samples = Foot::default().samples::<f32>();
    let mut once = EkfTracker::<f32>::new(Config::default());
    let mut twice = once;
    for sample in &samples {
        let expected = once.update(sample).unwrap();
        assert_eq!(twice.update(sample).unwrap(), expected);
        let again = twice.update(sample).unwrap();
        assert_eq!(
            (again.position, again.stance, again.stride),
            (expected.position, expected.stance, None)
        );
    }
}

#[test]
fn a_refused_sample_changes_nothing() {
    let samples = Foot::default().samples::<f32>();
    let mut clean = LiteTracker::<f32>::new(Config::default());
    let mut bothered = clean;
    for sample in &samples {
        let expected = clean.update(sample).unwrap();
        for (bad, error) in [
            (
                ImuSample { specific_force: SVector::from([0.0, f32::NAN, 0.0]), ..*sample },
                Error::NotFinite,
            ),
            (
                ImuSample { angular_rate: SVector::from([f32::INFINITY, 0., 0.]), ..*sample },
                Error::NotFinite,
            ),
            (
                ImuSample { specific_force: SVector::from([0., 0., 9.9e3]), ..*sample },
                Error::Implausible,
            ),
            (
                ImuSample { angular_rate: SVector::from([0., -1.8e3, 0.]), ..*sample },
                Error::Implausible,
            ),
        ] {
            assert_eq!(bothered.update(&bad), Err(error));
        }
        assert_eq!(bothered.update(sample), Ok(expected));
        // Repeated rates are skipped for less than 0.15 s: the last accepted sample is no older.
        if let Some(time_us) = sample.time_us.checked_sub(150_000) {
            let older = ImuSample { time_us, ..*sample };
            assert_eq!(bothered.update(&older), Err(Error::TimeBackwards));
        }
    }
}

#[test]
fn a_standstill_shows_the_bias_of_a_bare_chip_and_hardly_moves_that_of_a_good_one() {
    let bias = Vector3::new(0.05, -0.03, 0.02);
    let standing = Foot { headings: vec![], bias, ..Foot::default() };
    let learnt = |sensor| {
        let mut tracker = EkfTracker::<f64>::new(Config { sensor, ..Config::default() });
        for sample in standing.samples() {
            tracker.update(&sample).unwrap();
        }
        *tracker.alignment().gyro_bias()
    };
    assert!((learnt(SensorClass::Consumer) - bias).abs().max() < 1e-3);

    // A foot that sways for a second is no evidence of a bias for a gyroscope known to be good.
    let mut tracker =
        EkfTracker::<f64>::new(Config { sensor: SensorClass::Industrial, ..Config::default() });
    for mut sample in (Foot { headings: vec![], ..Foot::default() }).samples() {
        sample.angular_rate.x += 0.012 * (sample.time_us as f64 * 4e-6).sin();
        tracker.update(&sample).unwrap();
    }
    assert!(tracker.alignment().gyro_bias().abs().max() < 0.003);
}

#[test]
fn offline_names_the_sample_it_cannot_take() {
    let mut samples = Foot::default().samples::<f32>();
    let mut memory = vec![0.0; samples.len()];
    samples[7].angular_rate.y = f32::NAN;
    let refused = OfflineTracker::<f32, Lite<f32>>::new(Config::default(), &samples, &mut memory);
    assert_eq!(refused.err(), Some((7, Error::NotFinite)));
    samples.truncate(7);
    let refused =
        OfflineTracker::<f32, Lite<f32>>::new(Config::default(), &samples, &mut memory[..3]);
    assert_eq!(refused.err(), Some((3, Error::NoMemory)));
}

/// The shares of verdicts that are stance: while the foot stands, and in the middle of its swings.
fn stance_shares(mut detector: impl StanceDetector<f64>, noise: f64) -> (f64, f64) {
    let foot = Foot { noise, ..Foot::default() };
    let (mut standing, mut swinging) = (Vec::new(), Vec::new());
    for sample in foot.samples::<f64>() {
        let verdict = detector.update(&Motion {
            time_us: sample.time_us as u32,
            force_g: sample.specific_force / 9.80665,
            angular_rate: sample.angular_rate,
        });
        let t = sample.time_us as f64 * 1e-6 - 2.0;
        let (stride, phase) = ((t / 1.1).floor(), t.rem_euclid(1.1));
        let walking = (0.0..10.0).contains(&stride);
        if !walking || phase > 0.75 {
            standing.push(verdict.stance);
        } else if (0.2..0.4).contains(&phase) {
            swinging.push(verdict.stance);
        }
    }
    let share = |v: &[bool]| v.iter().filter(|s| **s).count() as f64 / v.len() as f64;
    (share(&standing), share(&swinging))
}

#[test]
fn detectors_tell_stance_from_swing() {
    for noise in [0.02, 0.1, 0.5] {
        let (standing, swinging) = stance_shares(Adaptive::default(), noise);
        assert!(standing > 0.95 && swinging < 0.05, "noise {noise}: {standing}, {swinging}");
    }
    for (standing, swinging) in [
        stance_shares(FixedShoe::new(FixedShoe::<f64>::THRESHOLD), 0.02),
        stance_shares(AngularRateEnergy::new(AngularRateEnergy::<f64>::THRESHOLD), 0.02),
        stance_shares(MovingVariance::new(MovingVariance::<f64>::THRESHOLD_G2), 0.02),
    ] {
        assert!(standing > 0.9 && swinging < 0.6, "{standing}, {swinging}");
    }
}

fn any_samples() -> impl Strategy<Value = Vec<(u32, [f32; 6])>> {
    let everyday = proptest::array::uniform6(-40.0..40.0f32);
    let anything = proptest::array::uniform6(any::<f32>());
    proptest::collection::vec((0..300_000_u32, prop_oneof![everyday, anything]), 1..200)
}

fn feed<T: Scalar>(stream: &[(u32, [f32; 6])]) {
    let mut lite = Tracker::<T, Lite<T>>::new(Config::default());
    let mut ekf = Tracker::<T, Ekf<T>>::new(Config::default());
    let mut time_us = 0;
    let mut good = Vec::new();
    for &(elapsed, [fx, fy, fz, wx, wy, wz]) in stream {
        time_us += u64::from(elapsed);
        let sample = ImuSample {
            time_us,
            specific_force: SVector::from([fx, fy, fz].map(T::from_f32)),
            angular_rate: SVector::from([wx, wy, wz].map(T::from_f32)),
        };
        let answers = (lite.update(&sample).is_ok(), ekf.update(&sample).is_ok());
        assert_eq!(answers.0, answers.1);
        if answers.0 {
            good.push(sample);
        }
    }
    let mut memory = vec![T::ZERO; good.len()];
    let tracker = OfflineTracker::<T, Ekf<T>>::new(Config::default(), &good, &mut memory).unwrap();
    assert_eq!(tracker.count(), good.len());
}

proptest! {
    #[test]
    fn no_stream_panics(stream in any_samples()) {
        feed::<f32>(&stream);
        feed::<Q12_20>(&stream);
    }
}
