//! Tests of the drift that is removed at the end of a stride.

use super::*;
use nalgebra::Vector3;

fn standing() -> Lite<f64> {
    Lite::start(SensorClass::Industrial, Orientation::identity())
}

/// A step of a foot at rest except for an acceleration (m/s²).
fn step(interval: f64, acceleration: Vector3<f64>) -> Step<f64> {
    let force_g = acceleration / STANDARD_GRAVITY + Vector3::z();
    Step { interval, force_g, angular_rate: Vector3::zeros(), turn: Vector3::zeros() }
}

fn stance(landing: bool) -> ZeroVelocity<f64> {
    ZeroVelocity { velocity: Vector3::zeros(), statistic: 0.0, interval: 0.01, landing }
}

/// The navigator after a swing of `steps` hundredths of a second with an acceleration.
fn swung(steps: u32, acceleration: Vector3<f64>) -> Lite<f64> {
    let mut lite = standing();
    (0..steps).for_each(|_| lite.propagate(&step(0.01, acceleration), false));
    lite
}

#[test]
fn a_constant_wrong_acceleration_is_taken_back_as_a_drift() {
    let acceleration = Vector3::new(0.3, -0.2, 0.1);
    let mut lite = swung(60, acceleration);
    assert!((lite.velocity() - acceleration * 0.6).norm() < 1e-9);
    lite.zero_velocity(&stance(true));
    assert!(lite.velocity().norm() < 1e-12 && lite.position().norm() < 1e-9, "{}", lite.position());
    // Once is enough.
    lite.zero_velocity(&stance(false));
    assert!(lite.position().norm() < 1e-9);
}

#[test]
fn half_of_the_tilt_that_explains_a_drift_is_put_right() {
    for (acceleration, landing, share) in [(0.3, true, 0.5), (-0.3, true, 0.5), (0.3, false, 0.0)] {
        let acceleration = Vector3::new(acceleration, 0.5 * acceleration, 0.0);
        let mut lite = swung(60, acceleration);
        lite.zero_velocity(&stance(landing));
        // The force that was mistaken for an acceleration points upwards.
        let force = acceleration / STANDARD_GRAVITY + Vector3::z();
        let left = lite.orientation().to_earth(&force);
        let expected = acceleration / STANDARD_GRAVITY * (1.0 - share);
        assert!((left.x - expected.x).hypot(left.y - expected.y) < 1e-4, "{left} {expected}");
    }
    // A drift within less than 0.3 s counts as if it had taken that long.
    let acceleration = Vector3::new(0.3, 0.0, 0.0);
    let mut lite = swung(15, acceleration);
    lite.zero_velocity(&stance(true));
    let tilt = lite.orientation().to_earth(&Vector3::z()).x;
    assert!((tilt.abs() - 0.25 * 0.3 / STANDARD_GRAVITY).abs() < 1e-5, "{tilt}");
}

#[test]
fn a_drift_is_linear_for_ten_seconds() {
    let acceleration = Vector3::new(0.01, 0.0, 0.0);
    for (steps, seconds) in [(900, 9.0), (1100, 10.0)] {
        let mut lite = swung(steps, acceleration);
        let (position, velocity) = (lite.position(), lite.velocity());
        lite.zero_velocity(&stance(true));
        let taken_back = position - lite.position();
        assert!((taken_back - velocity * (0.5 * seconds)).norm() < 1e-6, "{taken_back}");
    }
}

#[test]
fn gravity_levels_a_foot_that_stands_within_seconds() {
    let leaning = Orientation::identity().turned_in_earth(&Vector3::new(0.1, 0.0, 0.0));
    for (stands, most) in [(true, 0.01), (false, 0.11)] {
        let mut lite = Lite::<f64>::start(SensorClass::Industrial, leaning);
        for _ in 0..500 {
            lite.propagate(&step(0.01, Vector3::zeros()), stands);
        }
        let tilt = lite.orientation().to_earth(&Vector3::z()).xy().norm();
        assert!(tilt < most && (stands || tilt > 0.09), "{stands}: {tilt}");
    }
}

#[test]
fn gravity_is_shown_in_the_first_sample_of_a_stance_and_each_fourth_from_there() {
    let leaning = Orientation::identity().turned_in_earth(&Vector3::new(0.1, 0.0, 0.0));
    let mut lite = Lite::<f64>::start(SensorClass::Industrial, leaning);
    let mut tilts = [false, true, true, true, true, true, true, false, true].map(|stands| {
        lite.propagate(&step(0.01, Vector3::zeros()), stands);
        lite.orientation().to_earth(&Vector3::z()).xy().norm()
    });
    let mut before = 0.1_f64.sin();
    let shown = tilts.each_mut().map(|tilt| {
        let is_less = *tilt < before - 1e-5;
        before = *tilt;
        is_less
    });
    assert_eq!(shown, [false, true, false, false, false, true, false, false, true]);
}

#[test]
fn a_turn_that_was_missed_turns_what_was_pushed_since() {
    let mut lite = standing();
    let missed =
        MissedTurn { turn: Vector3::new(0.01, -0.02, 0.03), pushed: Vector3::new(0.3, 0.2, 4.0) };
    lite.miss(&missed);
    assert!((lite.velocity() - missed.turn.cross(&missed.pushed)).norm() < 1e-9);
    let expected = Orientation::identity().turned_in_earth(&missed.turn).to_earth(&Vector3::x());
    assert!((lite.orientation().to_earth(&Vector3::x()) - expected).norm() < 1e-9);
}

#[test]
fn begun_anew_it_is_where_the_swing_led_without_its_drift() {
    let mut lite = swung(50, Vector3::new(4.0, 0.0, 1.0));
    let (position, velocity) = (lite.position(), lite.velocity());
    let orientation = Orientation::identity().turned_in_earth(&Vector3::new(0.1, 0.0, 0.0));
    lite.restart(SensorClass::Industrial, orientation);
    assert!((lite.position() - (position - velocity * 0.25)).norm() < 1e-12);
    assert_eq!((lite.velocity(), lite.drifted), (Vector3::zeros(), 0.0));
    assert_eq!(lite.orientation().quaternion(), orientation.quaternion());
}

#[test]
fn a_stance_that_rolls_is_no_drift() {
    let rolling = Vector3::new(0.05, -0.04, 0.0);
    let mut lite = standing();
    lite.strapdown.velocity = rolling;
    lite.drifted = 0.5;
    lite.zero_velocity(&ZeroVelocity { velocity: rolling, ..stance(true) });
    assert_eq!((lite.velocity(), lite.position()), (rolling, Vector3::zeros()));
}
