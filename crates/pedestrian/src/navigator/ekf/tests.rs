//! Comparison of the filter with matrices and closed forms.

use super::*;
use crate::alignment::STANDARD_GRAVITY;
use nalgebra::{SMatrix, Vector3};

fn standing() -> Ekf<f64> {
    Ekf::start(SensorClass::Industrial, Orientation::identity())
}

/// A step of a foot at rest except for an acceleration (m/s², body).
fn step(interval: f64, acceleration: Vector3<f64>) -> Step<f64> {
    let force_g = acceleration / STANDARD_GRAVITY + Vector3::z();
    Step { interval, force_g, angular_rate: Vector3::zeros(), turn: Vector3::zeros() }
}

fn stance(velocity: Vector3<f64>) -> ZeroVelocity<f64> {
    ZeroVelocity { velocity, statistic: 0.0, interval: 0.005, landing: true }
}

/// The covariance in (m/s, rad)².
fn covariance(ekf: &Ekf<f64>) -> SMatrix<f64, 6, 6> {
    ekf.covariance().to_matrix() / 1000.0
}

#[test]
fn a_tilt_turns_what_the_force_has_pushed() {
    let mut ekf = standing();
    let root = SMatrix::<f64, 6, 6>::from_fn(|i, j| ((3 * i + 5 * j) % 7) as f64);
    let before = root * root.transpose();
    ekf.error.covariance = Covariance::from_lower_triangle(&(before * 1000.0));
    let pushed = Vector3::new(0.3, -0.5, 0.8);
    ekf.propagate_covariance(&pushed, 0.01);
    // δv ← δv + θ × u, and 5 mrad/√s.
    let mut f = SMatrix::<f64, 6, 6>::identity();
    for axis in 0..3 {
        let mut tilt = Vector3::zeros();
        tilt[axis] = 1.0;
        f.fixed_view_mut::<3, 1>(0, 3 + axis).copy_from(&tilt.cross(&pushed));
    }
    let mut after = f * before * f.transpose();
    for axis in 3..6 {
        after[(axis, axis)] += 0.005 * 0.005 * 0.01;
    }
    assert!((covariance(&ekf) - after).amax() < 1e-9, "{}", covariance(&ekf) - after);
}

#[test]
fn it_begins_at_rest_and_nearly_level() {
    let sigmas = covariance(&standing()).diagonal().map(f64::sqrt);
    for (found, expected) in sigmas.iter().zip([0.0, 0.0, 0.0, 0.02, 0.02, 0.0]) {
        assert!((found - expected).abs() < 1e-9, "{sigmas}");
    }
}

#[test]
fn a_swing_of_more_than_three_seconds_grows_no_more_uncertain() {
    let tilt = |seconds: u32| {
        let mut ekf = standing();
        (0..10 * seconds).for_each(|_| ekf.propagate(&step(0.1, Vector3::zeros()), false));
        (covariance(&ekf)[(3, 3)], ekf.swing)
    };
    assert!(tilt(2).0 < tilt(3).0);
    assert!((tilt(4).0 - tilt(9).0).abs() < 1e-15 && tilt(9).1 < 3.2, "{:?}", tilt(9));
}

#[test]
fn half_of_a_velocity_error_times_the_swing_is_taken_back() {
    let mut ekf = standing();
    for _ in 0..60 {
        ekf.propagate(&step(0.01, Vector3::new(0.5, 0.0, -0.2)), false);
    }
    let (before, drifted) = (ekf.position(), ekf.velocity());
    assert!((drifted - Vector3::new(0.3, 0.0, -0.12)).norm() < 1e-9, "{drifted}");
    ekf.zero_velocity(&stance(Vector3::zeros()));
    let taken_back = ekf.velocity() - drifted;
    assert!(ekf.velocity().norm() < 0.01, "{}", ekf.velocity());
    assert!((ekf.position() - before - taken_back * 0.3).norm() < 1e-12);
    // A second one right after it has nothing to correct.
    let there = ekf.position();
    ekf.zero_velocity(&stance(Vector3::zeros()));
    assert_eq!(ekf.position(), there);
}

#[test]
fn a_drift_forwards_was_a_tilt_forwards() {
    let mut ekf = standing();
    // The foot is level by its own estimate; the force shows that it is tilted by a hundredth.
    for _ in 0..60 {
        ekf.propagate(&step(0.01, Vector3::new(0.098, 0.0, 0.0)), false);
    }
    ekf.zero_velocity(&stance(Vector3::zeros()));
    let up = ekf.orientation().to_earth(&Vector3::new(0.01, 0.0, 1.0));
    // Nearer to the vertical than before, when it was 0.01.
    assert!((0.0..0.009).contains(&up.x) && up.y.abs() < 1e-6, "{up}");
}

/// The variance of the first velocity component after a swing of `seconds` and a stance.
fn known(seconds: f64, zero: ZeroVelocity<f64>) -> f64 {
    let mut ekf = standing();
    ekf.error.covariance = Covariance::zero();
    ekf.swing = seconds;
    ekf.zero_velocity(&zero);
    covariance(&ekf)[(0, 0)]
}

#[test]
fn a_zero_velocity_is_worth_two_centimetres_a_second() {
    // After a random walk of 0.3 m/s/√s, and a measurement of variance R, P R/(P + R) is left.
    let left = |seconds: f64, r: f64| {
        let p = 0.3 * 0.3 * seconds;
        p * r / (p + r)
    };
    let zero = stance(Vector3::zeros());
    let is_near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-6;
    assert!(is_near(known(0.5, zero), left(0.5, 4e-4)));
    assert!(is_near(known(0.001, zero), left(0.001, 4e-4)));
    // At twice the rate each has half the weight; a foot in doubt has half the weight; no interval counts as less than
    // a millisecond.
    assert!(is_near(known(0.5, ZeroVelocity { interval: 0.0025, ..zero }), left(0.5, 8e-4)));
    assert!(is_near(known(0.5, ZeroVelocity { statistic: 0.3, ..zero }), left(0.5, 8e-4)));
    assert!(is_near(known(0.5, ZeroVelocity { interval: 1e-9, ..zero }), left(0.5, 2e-3)));
}

#[test]
fn a_stance_may_roll() {
    let mut ekf = standing();
    ekf.swing = 1.0;
    let rolling = Vector3::new(0.05, -0.04, 0.0);
    (0..3).for_each(|_| ekf.zero_velocity(&stance(rolling)));
    assert!((ekf.velocity() - rolling).norm() < 1e-3, "{}", ekf.velocity());
}

#[test]
fn a_turn_that_was_missed_turns_what_was_pushed_since_and_is_in_doubt() {
    let mut ekf = standing();
    ekf.orientation = Orientation::identity().turned_in_earth(&Vector3::new(0.0, 0.0, 0.5));
    ekf.error.covariance = Covariance::zero();
    let missed =
        MissedTurn { turn: Vector3::new(0.01, -0.02, 0.03), pushed: Vector3::new(0.3, 0.2, 4.0) };
    let turn = ekf.orientation.to_earth(&missed.turn);
    let before = ekf.orientation;
    ekf.miss(&missed);
    let velocity = turn.cross(&missed.pushed);
    assert!((ekf.velocity() - velocity).norm() < 1e-12, "{}", ekf.velocity());
    let (found, expected) = (ekf.orientation, before.turned_in_earth(&turn));
    assert!((found.to_earth(&Vector3::x()) - expected.to_earth(&Vector3::x())).norm() < 1e-12);
    // Half of the turn and all its consequences, and half of that for the heading.
    let doubtful = [velocity.x, velocity.y, velocity.z, turn.x, turn.y, 0.5 * turn.z];
    let doubtful = SVector::<f64, 6>::from(doubtful) * 0.5;
    let p = doubtful * doubtful.transpose();
    assert!((covariance(&ekf) - p).amax() < 1e-9 * p.amax(), "{} {p}", covariance(&ekf));
}

#[test]
fn begun_anew_it_is_where_the_swing_led_without_its_drift() {
    let mut ekf = standing();
    for _ in 0..50 {
        ekf.propagate(&step(0.01, Vector3::new(4.0, 0.0, 1.0)), false);
    }
    let (position, velocity) = (ekf.position(), ekf.velocity());
    let orientation = Orientation::identity().turned_in_earth(&Vector3::new(0.1, 0.0, 0.0));
    ekf.restart(SensorClass::Industrial, orientation);
    assert!((ekf.position() - (position - velocity * 0.25)).norm() < 1e-12);
    assert_eq!((ekf.velocity(), ekf.swing), (Vector3::zeros(), 0.0));
    assert_eq!(ekf.orientation().quaternion(), orientation.quaternion());
    assert_eq!(covariance(&ekf), covariance(&standing()));
}

#[test]
fn three_velocities_are_taken_in_as_one() {
    let p = SMatrix::<f64, 3, 3>::new(0.04, 0.02, 0.01, 0.02, 0.05, -0.015, 0.01, -0.015, 0.03);
    let mut all = SMatrix::<f64, 6, 6>::zeros();
    all.fixed_view_mut::<3, 3>(0, 0).copy_from(&(p * 1000.0));
    let mut ekf = standing();
    ekf.error.covariance = Covariance::from_lower_triangle(&all);
    let (before, zero) = (Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.05, 0.0, 0.0));
    ekf.strapdown.velocity = before;
    ekf.zero_velocity(&ZeroVelocity { statistic: 30.0, ..stance(zero) });
    // 101 times the variance of a foot at rest.
    let s = p + SMatrix::<f64, 3, 3>::identity() * (101.0 * 4e-4);
    let expected = before + p * s.try_inverse().expect("a covariance") * (zero - before);
    assert!((ekf.velocity() - expected).norm() < 1e-9, "{} {expected}", ekf.velocity());
}
