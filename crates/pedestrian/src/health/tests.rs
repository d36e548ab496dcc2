//! Tests of findings about a stream, at their bounds.

use super::*;
use nalgebra::Vector3;

fn found(change: impl FnOnce(&mut Health<f64>)) -> Warnings {
    let mut health = Health::new();
    // All tests below are about streams that stood once.
    health.standstill(1.0, true, SensorClass::Industrial);
    assert_eq!(health.warnings(), Warnings::default());
    change(&mut health);
    health.warnings()
}

#[test]
fn words_are_those_of_what_was_found() {
    let none = Warnings::default();
    for (warnings, reason) in [
        (Warnings { accelerometer_saturated: true, ..none }, Reason::Saturated),
        (Warnings { gyroscope_saturated: true, ..none }, Reason::Saturated),
        (Warnings { gaps: true, ..none }, Reason::Dropout),
        (Warnings { tilt_lost: true, ..none }, Reason::Dropout),
        (Warnings { never_still: true, ..none }, Reason::NotObservable),
        (Warnings { gravity_implausible: true, ..none }, Reason::Units),
        (Warnings { rate_implausible: true, ..none }, Reason::Units),
        (Warnings { axes_inconsistent: true, ..none }, Reason::Axes),
        (Warnings { landings_implausible: true, ..none }, Reason::Innovations),
        (Warnings { out_of_range: true, ..none }, Reason::Range),
    ] {
        assert_eq!(warnings.health(), kestirim_health::Health::GOOD.with(reason, true));
    }
    assert_eq!(none.health(), kestirim_health::Health::GOOD);
    assert!(Health::<f64>::new().warnings().never_still);
    for knows_bias in [false, true] {
        let mut health = Health::<f64>::new();
        health.standstill(1.0, knows_bias, SensorClass::Consumer);
        assert_eq!(health.warnings().never_still, !knows_bias, "a person who sways shows no bias");
    }
    assert!(found(Health::gap).gaps && found(Health::clipped).gyroscope_saturated);
}

/// Values along one axis: `count` runs of `length` samples of the same value, each followed by another one.
fn runs(
    count: usize,
    length: usize,
    axis: usize,
    value: f64,
) -> impl Iterator<Item = Vector3<f64>> {
    (0..count * (length + 1)).map(move |k| {
        let mut vector = Vector3::new(0.1 * k as f64, 0.2 * k as f64, 0.3 * k as f64);
        vector[axis] = if k % (length + 1) == length { 0.5 * value } else { value };
        vector
    })
}

#[test]
fn a_range_ends_where_a_large_value_is_shown_three_times_more_often_than_by_chance() {
    for axis in 0..3 {
        for (count, length, value, saturated) in [
            (6, 3, 18.5, true),
            (6, 3, -18.5, true),
            (5, 3, 18.5, false),
            (6, 2, 18.5, false),
            (6, 3, 17.5, false),
            // One long run counts once.
            (1, 40, 18.5, false),
        ] {
            let warnings = found(|health| {
                runs(count, length, axis, value).for_each(|force| health.large_force(&force));
            });
            assert_eq!(warnings.accelerometer_saturated, saturated, "{count} {length} {value}");
            let warnings = found(|health| {
                let scale = 4.2 / 18.0;
                let rates = runs(count, length, axis, value).map(|rate| rate * scale);
                rates.for_each(|rate| health.large_rate(&rate));
            });
            assert_eq!(warnings.gyroscope_saturated, saturated, "{count} {length} {value}");
        }
    }
}

#[test]
fn no_foot_turns_faster_than_any_gyroscope_measures() {
    for axis in 0..3 {
        for (rate, implausible) in [(44.9, false), (-44.9, false), (45.1, true), (-45.1, true)] {
            let mut vector = Vector3::new(1.0, 2.0, 3.0);
            vector[axis] = rate;
            let warnings = found(|health| health.large_rate(&vector));
            assert_eq!(warnings.rate_implausible, implausible, "{vector}");
        }
    }
}

#[test]
fn gravity_at_rest_is_that_of_the_earth() {
    for (gravity, sensor, implausible) in [
        (1.049, SensorClass::Industrial, false),
        (0.951, SensorClass::Industrial, false),
        (1.051, SensorClass::Industrial, true),
        (0.949, SensorClass::Industrial, true),
        (1.119, SensorClass::Consumer, false),
        (0.879, SensorClass::Consumer, true),
    ] {
        let warnings = found(|health| health.standstill(gravity, true, sensor));
        assert_eq!(warnings.gravity_implausible, implausible, "{gravity} {sensor:?}");
    }
}

/// The warnings after a number of landings with the same residual velocity, and how many of them lost the tilt.
fn landed(
    count: u32,
    velocity: [f64; 3],
    before: impl FnOnce(&mut Health<f64>),
) -> (Warnings, u32) {
    let mut lost = 0;
    let warnings = found(|health| {
        before(health);
        for _ in 0..count {
            lost += u32::from(health.landing(&velocity.into(), 0.005, SensorClass::Industrial));
        }
    });
    (warnings, lost)
}

#[test]
fn a_landing_at_metres_a_second_has_lost_the_tilt_and_four_are_of_wrong_axes() {
    for axis in 0..3 {
        let at = |speed: f64| {
            let mut velocity = [0.0; 3];
            velocity[axis] = speed;
            velocity
        };
        for speed in [2.01, -2.01] {
            let (warnings, lost) = landed(3, at(speed), |_| ());
            assert!(warnings.tilt_lost && !warnings.axes_inconsistent && lost == 3, "{warnings:?}");
            assert!(landed(4, at(speed), |_| ()).0.axes_inconsistent, "{speed}");
            // A clipped gyroscope leaves as much.
            let (warnings, _) = landed(9, at(speed), Health::clipped);
            assert!(warnings.tilt_lost && !warnings.axes_inconsistent, "{warnings:?}");
        }
        let (warnings, lost) = landed(9, at(1.99), |_| ());
        assert!(!warnings.tilt_lost && !warnings.axes_inconsistent && lost == 0, "{warnings:?}");
    }
}

#[test]
fn landings_are_averaged_over_eight() {
    // Each landing counts for at most two metres per second sideways and half a metre per second upwards.
    let implausible = |count, velocity| landed(count, velocity, |_| ()).0.landings_implausible;
    for axis in 0..2 {
        let mut wild = [0.0; 3];
        wild[axis] = -1000.0;
        // 2 · (1 − (7/8)ⁿ) > 0.75 from n = 4 on.
        assert!(!implausible(3, wild) && implausible(4, wild), "{wild:?}");
        wild[axis] = 0.74;
        assert!(!implausible(100, wild), "{wild:?}");
        wild[axis] = 0.76;
        assert!(!implausible(8, wild) && implausible(100, wild), "{wild:?}");
    }
    // 0.5 · (1 − (7/8)ⁿ) > 0.12 from n = 3 on.
    assert!(!implausible(2, [0.0, 0.0, -1000.0]) && implausible(3, [0.0, 0.0, -1000.0]));
    assert!(!implausible(100, [0.0, 0.0, -0.119]) && implausible(100, [0.0, 0.0, -0.121]));
}

#[test]
fn a_foot_does_not_land_upwards_on_average() {
    let told = |interval: f64, landings: &[f64]| {
        let land = |health: &mut Health<f64>| {
            for &upwards in landings {
                health.landing(&[0.0, 0.0, upwards].into(), interval, SensorClass::Consumer);
            }
        };
        found(land).landings_implausible
    };
    assert!(told(0.005, &[0.036; 100]) && !told(0.005, &[0.034; 100]));
    assert!(!told(0.005, &[-0.1; 100]) && !told(0.005, &[0.1, -0.05].repeat(50)));
    // Fewer samples leave more to chance.
    assert!(told(0.01, &[0.071; 100]) && !told(0.01, &[0.069; 100]));
    // Two odd landings are no fault: 4 · (1 − (7/8)ⁿ) > 1 from n = 3 on.
    assert!(!told(0.005, &[0.4; 2]) && told(0.005, &[0.4; 3]));
}

#[test]
fn strides_that_end_elsewhere_by_much_of_their_length_are_told() {
    let told = |strides: &[(f64, f64)]| {
        found(|health| strides.iter().for_each(|(length, moved)| health.stride(*length, *moved)))
            .landings_implausible
    };
    let (shuffled, walked) = ((0.24, 0.14), (1.3, 0.1));
    assert!(told(&[shuffled; 6]) && !told(&[shuffled; 5]));
    assert!(!told(&[walked; 100]));
    // An occasional stumble is no fault.
    let stumbles: [_; 100] = core::array::from_fn(|at| if at % 2 == 0 { shuffled } else { walked });
    assert!(!told(&stumbles));
}
