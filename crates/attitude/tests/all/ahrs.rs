//! The attitude and heading reference on motions with known orientation.

use kestirim_attitude::{Ahrs, Error, Gains, Orientation};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{SVector, Vector3};

const GRAVITY: f64 = 9.80665;

fn cast<T: Scalar>(v: Vector3<f64>) -> SVector<T, 3> {
    v.map(T::from_f64)
}

/// The tilt error of the reference after `seconds` of swaying with a biased gyroscope (rad).
fn tilt_error_after_swaying<T: Scalar>(gains: Gains<T>, seconds: f64) -> f64 {
    let bias = Vector3::new(0.02, -0.015, 0.0);
    let mut truth = Orientation::<f64>::identity();
    let mut ahrs = Ahrs::<T>::new(Orientation::identity(), SVector::zeros(), gains);
    let interval = 0.01;
    let steps = (seconds / interval) as usize;
    for step in 0..steps {
        let t = step as f64 * interval;
        let rate =
            Vector3::new(0.4 * (1.3 * t).sin(), 0.3 * (0.9 * t).cos(), 0.2 * (0.5 * t).sin());
        truth = truth.turned_in_body(&(rate * interval));
        let force = truth.to_body(&Vector3::new(0.0, 0.0, GRAVITY));
        ahrs.update(&cast(rate + bias), Some(&cast(force)), T::from_f64(interval)).unwrap();
    }
    let up = truth.to_body(&Vector3::z());
    ahrs.orientation().to_earth(&cast(up)).map(T::to_f64).cross(&Vector3::z()).norm()
}

#[test]
fn gravity_corrects_a_drifting_gyroscope() {
    let no_correction = Gains { tilt: 0.0, bias: 0.0, gate: 0.1 };
    assert!(tilt_error_after_swaying(no_correction, 60.0) > 0.3);
    assert!(tilt_error_after_swaying::<f64>(Gains::default(), 180.0) < 2e-3);
    assert!(tilt_error_after_swaying::<f32>(Gains::default(), 180.0) < 2e-3);
    assert!(tilt_error_after_swaying::<Q12_20>(Gains::default(), 180.0) < 4e-3);
}

#[test]
fn a_force_that_is_not_gravity_is_not_listened_to() {
    let mut ahrs = Ahrs::<f64>::new(Orientation::identity(), SVector::zeros(), Gains::default());
    for _ in 0..100 {
        ahrs.update(&SVector::zeros(), Some(&SVector::from([8.0, 0.0, GRAVITY])), 0.01).unwrap();
    }
    assert_eq!(ahrs.orientation(), &Orientation::identity());
}

#[test]
fn a_refused_sample_changes_nothing() {
    let mut ahrs = Ahrs::<f32>::new(Orientation::identity(), SVector::zeros(), Gains::default());
    let before = ahrs;
    let (good, bad) = (SVector::from([0.0, 0.0, 9.8]), SVector::from([0.0, f32::NAN, 0.0]));
    assert_eq!(ahrs.update(&bad, Some(&good), 0.01), Err(Error::NotFinite));
    assert_eq!(ahrs.update(&good, Some(&bad), 0.01), Err(Error::NotFinite));
    assert_eq!(ahrs.update(&good, Some(&good), f32::INFINITY), Err(Error::NotFinite));
    assert_eq!(ahrs.update(&good, Some(&good), -0.01), Err(Error::NegativeInterval));
    assert_eq!(
        ahrs.update(&SVector::from([f32::MAX, 0.0, 0.0]), None, 1e30),
        Err(Error::NotFinite)
    );
    assert_eq!(ahrs, before);
}

#[test]
fn a_turn_is_rate_times_interval() {
    let (rate, interval) = (Vector3::new(0.3, -2.0, 1.1), 0.01);
    let begun = Ahrs::<f64>::new(Orientation::identity(), Vector3::zeros(), Gains::default());
    let (mut by_rate, mut by_turn) = (begun, begun);
    for _ in 0..10 {
        by_rate.update(&rate, None, interval).expect("a sample");
        by_turn.turn_in_body(&(rate * interval));
    }
    assert_eq!(by_rate.orientation(), by_turn.orientation());
}
