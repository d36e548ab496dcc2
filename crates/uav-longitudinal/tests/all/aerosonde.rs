//! The Aerosonde: its published coefficients reproduce the card's numbers.

use kestirim_uav_longitudinal::{
    Airframe, Descriptor, Error, Stall, StateSpace, SteadyFlight, Trim, aerosonde,
};
use nalgebra::{Matrix4, Matrix4x2, SMatrix, SVector};

const CLIMB: SteadyFlight =
    SteadyFlight { airspeed: 40.0, climb_angle: 4.0 * std::f64::consts::PI / 180.0 };

fn card() -> StateSpace {
    #[rustfmt::skip]
    let a = Matrix4::new(
        -3.611_424_711_888_206_6, 1.0, -0.012_585_232_601_555_377, -0.017_107_775_185_746_733,
        -35.484_982_394_361_23, -0.798_159_973_735_062_4, 0.0, 0.0,
        8.336_030_097_570_347, 0.0, -0.854_322_788_216_258_2, -9.786_103_333_048_876,
        0.0, 1.0, 0.0, 0.0,
    );
    #[rustfmt::skip]
    let b = Matrix4x2::new(
        0.372_005_333_333_333_35, 0.026_115_295_673_637_393,
        -46.690_766_308_370_04, 0.0,
        0.0, 65.808_892_115_602_13,
        0.0, 0.0,
    );
    StateSpace { a, b }
}

fn difference(ours: &StateSpace, other: &StateSpace) -> f64 {
    let pairs = ours.a.iter().zip(&other.a).chain(ours.b.iter().zip(&other.b));
    pairs.map(|(x, y)| (x - y).abs() / y.abs().max(1e-2)).fold(0.0, f64::max)
}

#[test]
fn p1_is_computed_to_the_last_digit_of_the_card() -> Result<(), Error> {
    let trim = Airframe::aerosonde().trim(&CLIMB)?;
    let found = [trim.state[0], trim.state[3], trim.input[0], trim.input[1]];
    let published = [-0.015_872_081_6, 0.053_941_088_5, -0.034_697_218_0, 0.540_071_902_2];
    for (found, published) in found.iter().zip(published) {
        assert!((found - published).abs() <= 0.5e-10, "{found} {published}");
    }
    let worst = difference(&aerosonde()?, &card());
    assert!(worst < 3e-14, "{worst}");
    Ok(())
}

#[test]
fn with_stall_it_is_hardly_another_aircraft_at_40_metres_a_second() -> Result<(), Error> {
    let mut airframe = Airframe::aerosonde();
    airframe.lift.stall = Some(Stall::aerosonde());
    let model = airframe.linearise(&airframe.trim(&CLIMB)?)?;
    let worst = difference(&model, &card());
    assert!(worst > 1e-11 && worst < 1e-9, "{worst}");
    // Far beyond the stall the lift is that of a flat plate, with the sign of α.
    let lift = |alpha: f64| -> Result<f64, Error> {
        let state = SVector::from([alpha, 0.0, 40.0, alpha]);
        let alpha_dot = airframe.rates(&state, &SVector::from([0.0, 0.5]))?[0];
        // α̇ = −(L + T·sin α)/(m·V) + g/V, with no thrust at δt = V/k.
        let pressure = 0.5 * airframe.air_density * 1600.0 * airframe.wing_area;
        Ok((9.81 / 40.0 - alpha_dot) * airframe.mass * 40.0 / pressure)
    };
    let plate = |alpha: f64| 2.0 * alpha.signum() * alpha.sin().powi(2) * alpha.cos();
    for alpha in [-1.2, -0.8, 0.8, 1.2] {
        assert!((lift(alpha)? - plate(alpha)).abs() < 1e-6, "{alpha}");
    }
    assert!((lift(0.1)? - (0.28 + 3.45 * 0.1)).abs() < 1e-6);
    Ok(())
}

#[test]
fn stability_derivatives_are_another_way_to_the_same_model() -> Result<(), Error> {
    let mut airframe = Airframe::aerosonde();
    // Terms that the Aerosonde does not have.
    airframe.lift.pitch_rate = 4.0;
    airframe.lift.stall = Some(Stall { alpha: 0.2, sharpness: 30.0 });
    for flight in [CLIMB, SteadyFlight { airspeed: 25.0, climb_angle: -0.1 }] {
        let trim = airframe.trim(&flight)?;
        assert!(airframe.rates(&trim.state, &trim.input)?.norm() < 1e-13);
        let descriptor = airframe.longitudinal(&trim)?.descriptor();
        let worst = difference(&descriptor.resolve()?, &airframe.linearise(&trim)?);
        assert!(worst < 1e-12, "{worst}");
    }
    Ok(())
}

/// E exists for downwash lag.
#[test]
fn e_holds_what_depends_on_accelerations() -> Result<(), Error> {
    let airframe = Airframe::aerosonde();
    let mut derivatives = airframe.longitudinal(&airframe.trim(&CLIMB)?)?;
    derivatives.z_alpha_dot = -2.0;
    derivatives.m_alpha_dot = -0.7;
    let Descriptor { e, a, b } = derivatives.descriptor();
    assert_eq!((e[(0, 0)], e[(1, 0)]), (42.0, 0.7));
    let model = derivatives.descriptor().resolve()?;
    assert!((e * model.a - a).amax() < 1e-12 && (e * model.b - b).amax() < 1e-12);
    // By hand: V̇ and θ̇ are unaffected, α̇ is divided by V − Zα̇, q̇ gains Mα̇·α̇.
    let plain = card();
    assert!((model.a[(0, 1)] - 40.0 / 42.0).abs() < 1e-12);
    let q_row = plain.a.row(1) - 0.7 * model.a.row(0);
    assert!((model.a.row(1) - q_row).amax() < 1e-12);
    assert!((model.a.row(2) - plain.a.row(2)).amax() < 1e-12);
    derivatives.z_alpha_dot = 40.0;
    assert_eq!(derivatives.descriptor().resolve(), Err(Error::Singular));
    Ok(())
}

/// The book's lateral model about the body's axes (v = V·β), where only p and r are rotated by α.
#[test]
fn lateral_model_is_the_books_turned_by_alpha() -> Result<(), Error> {
    let airframe = Airframe::aerosonde();
    let trim = airframe.trim(&CLIMB)?;
    let Trim { state, .. } = trim;
    let (alpha, speed, theta) = (state[0], state[2], state[3]);
    let model = airframe.lateral(&trim)?.descriptor().resolve()?;
    let area = 0.5 * airframe.air_density * speed * airframe.wing_area;
    let b = airframe.span;
    let [x, z, xz] = [airframe.inertia.x, airframe.inertia.z, airframe.inertia.xz];
    let gamma = x * z - xz * xz;
    let mix = |l: f64, n: f64| [(z * l + xz * n) / gamma, (xz * l + x * n) / gamma];
    let (y, l, n) = (airframe.side_force, airframe.rolling, airframe.yawing);
    let of_sideslip = mix(l.sideslip, n.sideslip);
    let of_roll = mix(l.roll_rate, n.roll_rate);
    let of_yaw = mix(l.yaw_rate, n.yaw_rate);
    let of_aileron = mix(l.aileron, n.aileron);
    let of_rudder = mix(l.rudder, n.rudder);
    let moment = area * speed * b;
    let damped = area * b * b / 2.0;
    #[rustfmt::skip]
    let body = Matrix4::new(
        area * y.sideslip / airframe.mass, 9.81 * theta.cos() / speed, alpha.sin(), -alpha.cos(),
        0.0, 0.0, 1.0, theta.tan(),
        moment * of_sideslip[0], 0.0, damped * of_roll[0], damped * of_yaw[0],
        moment * of_sideslip[1], 0.0, damped * of_roll[1], damped * of_yaw[1],
    );
    #[rustfmt::skip]
    let inputs = Matrix4x2::new(
        0.0, area * y.rudder / airframe.mass,
        0.0, 0.0,
        moment * of_aileron[0], moment * of_rudder[0],
        moment * of_aileron[1], moment * of_rudder[1],
    );
    let (sin, cos) = alpha.sin_cos();
    #[rustfmt::skip]
    let turn = Matrix4::new(
        1.0, 0.0, 0.0, 0.0,
        0.0, 1.0, 0.0, 0.0,
        0.0, 0.0, cos, sin,
        0.0, 0.0, -sin, cos,
    );
    assert!((turn * body * turn.transpose() - model.a).amax() < 1e-12);
    assert!((turn * inputs - model.b).amax() < 1e-12);
    Ok(())
}

#[test]
fn what_cannot_fly_is_refused() {
    let airframe = Airframe::aerosonde();
    let trim = |airspeed, climb_angle| airframe.trim(&SteadyFlight { airspeed, climb_angle });
    assert_eq!(trim(f64::NAN, 0.0), Err(Error::NotFinite));
    assert_eq!(trim(40.0, f64::INFINITY), Err(Error::NotFinite));
    assert_eq!(trim(-1.0, 0.0), Err(Error::NotPositive));
    assert_eq!(trim(77.0, 0.0), Err(Error::BeyondThrottle));
    let mut heavy = airframe;
    heavy.mass = 500.0;
    heavy.lift.stall = Some(Stall::aerosonde());
    assert_eq!(heavy.trim(&CLIMB), Err(Error::BeyondThrottle));
    let mut without_elevator = airframe;
    without_elevator.pitch.elevator = 0.0;
    without_elevator.pitch.alpha = 0.0;
    assert_eq!(without_elevator.trim(&CLIMB), Err(Error::NotConverged));
    for wrong in [0.0, -1.0, f64::NAN] {
        let mut shapeless = airframe;
        shapeless.wing_area = wrong;
        assert!(shapeless.trim(&CLIMB).is_err());
    }
    let mut thin = airframe;
    thin.inertia.xz = (thin.inertia.x * thin.inertia.z).sqrt();
    let flight = airframe.trim(&CLIMB).unwrap();
    assert_eq!(thin.lateral(&flight), Err(Error::Singular));
    let nothing =
        Descriptor { e: SMatrix::identity(), a: SMatrix::repeat(f64::NAN), b: SMatrix::zeros() };
    assert_eq!(nothing.resolve(), Err(Error::NotFinite));
}
