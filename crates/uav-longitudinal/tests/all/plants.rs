//! The example plants, their output matrices, and the absence of panics.

use kestirim_uav_longitudinal::{
    Airframe, Descriptor, Drag, LongitudinalDerivatives, Stall, SteadyFlight, Trim,
    airspeed_and_pitch, full_state, navion, rate_airspeed_and_pitch, thesis_like,
};
use nalgebra::{SMatrix, SVector};
use proptest::prelude::*;

#[test]
fn rows_are_rows() {
    let p2 = thesis_like();
    assert_eq!((p2.a[(1, 0)], p2.a[(2, 3)], p2.b[(2, 1)]), (-25.0, -9.786_103_333_048_876, 45.0));
    let p3 = navion();
    assert_eq!((p3.a[(2, 0)], p3.a[(0, 3)], p3.b[(1, 0)]), (1.931_212_8, 0.0, -11.1874));
    for plant in [p2, p3] {
        assert_eq!(plant.a.row(3), SMatrix::<f64, 1, 4>::from([[0.0], [1.0], [0.0], [0.0]]));
    }
}

#[test]
fn outputs_pick_states() {
    let state = SVector::from([0.1, 0.2, 40.0, 0.5]);
    assert_eq!(full_state() * state, state);
    assert_eq!(rate_airspeed_and_pitch() * state, SVector::from([0.2, 40.0, 0.5]));
    assert_eq!(airspeed_and_pitch() * state, SVector::from([40.0, 0.5]));
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![-3.0..3.0f64, -1e3..1e3f64, any::<f64>()]
}

proptest! {
    #[test]
    fn no_airframe_panics(
        numbers in proptest::array::uniform32(number()),
        stalls in any::<bool>(),
    ) {
        let mut airframe =
            if stalls { Airframe::aerosonde() } else { Airframe::skywalker_x8() };
        if let Drag::Polynomial { zero, .. } = &mut airframe.drag { *zero = numbers[22]; }
        let fields = [
            &mut airframe.mass, &mut airframe.span, &mut airframe.lift.zero,
            &mut airframe.lift.alpha, &mut airframe.lift.elevator,
            &mut airframe.pitch.zero, &mut airframe.pitch.alpha, &mut airframe.pitch.elevator,
            &mut airframe.propeller.motor, &mut airframe.inertia.xz,
        ];
        // One in four is broken: if all were, none would pass the first check.
        for (field, pair) in fields.into_iter().zip(numbers.chunks(2)) {
            if pair[0] > 1.5 { *field = pair[1]; }
        }
        if stalls {
            airframe.lift.stall = Some(Stall { alpha: numbers[22], sharpness: numbers[23] });
        }
        let trim = airframe.trim(&SteadyFlight {
            airspeed: 30.0 + numbers[24], climb_angle: numbers[25] * 0.1,
        });
        if let Ok(trim) = trim {
            let left = airframe.rates(&trim.state, &trim.input).unwrap();
            prop_assert!(left.iter().all(|rate| rate.is_finite()));
        }
        let flight = trim.unwrap_or(Trim {
            state: SVector::from([numbers[26], numbers[27], numbers[28], numbers[29]]),
            input: SVector::from([numbers[30], numbers[31]]),
        });
        let _ = airframe.lateral(&flight);
        let _ = airframe.longitudinal(&flight).map(|it| it.descriptor().resolve());
        if let Ok(model) = airframe.linearise(&flight) {
            prop_assert!(model.a.iter().chain(&model.b).all(|number| number.is_finite()));
        }
    }

    #[test]
    fn a_resolved_model_satisfies_its_descriptor(
        numbers in proptest::array::uniform16(-50.0..50.0f64),
        airspeed in 5.0..80.0f64,
    ) {
        let derivatives = LongitudinalDerivatives {
            airspeed, gravity: 9.81, thrust_angle: numbers[0] * 0.01, climb_angle: numbers[1] * 0.01,
            x_alpha: numbers[2], x_airspeed: numbers[3], x_thrust_airspeed: numbers[4],
            x_elevator: numbers[5], x_throttle: numbers[6], z_alpha: numbers[7],
            z_alpha_dot: numbers[8] * 0.05, z_pitch_rate: numbers[9], z_airspeed: numbers[10],
            z_elevator: numbers[11], m_alpha: numbers[12], m_alpha_dot: numbers[13],
            m_pitch_rate: numbers[14], m_elevator: numbers[15],
            ..LongitudinalDerivatives::default()
        };
        let Descriptor { e, a, b } = derivatives.descriptor();
        let model = derivatives.descriptor().resolve().unwrap();
        prop_assert!((e * model.a - a).amax() < 1e-10 && (e * model.b - b).amax() < 1e-10);
    }

    #[test]
    fn no_descriptor_panics(numbers in proptest::collection::vec(number(), 40)) {
        let descriptor = Descriptor {
            e: SMatrix::from_column_slice(&numbers[..16]),
            a: SMatrix::from_column_slice(&numbers[16..32]),
            b: SMatrix::from_column_slice(&numbers[32..]),
        };
        if let Ok(model) = descriptor.resolve() {
            prop_assert!(model.a.iter().chain(&model.b).all(|number| number.is_finite()));
        }
    }
}
