//! The consequences of the thesis' formulas as printed: the book's proofs that they are misprints.

use host_sim::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, START};
use kestirim_observer_design::{eigenvalues, riccati, zero_order_hold};
use kestirim_replay::uav::{Noise, Plant};
use kestirim_uav_longitudinal::{Airframe, SteadyFlight, full_state};
use nalgebra::{Matrix4, RowVector4, SVector, Vector3};

/// (3.4.1): Zα and Mα, where Zα̇ and Mα̇ belong, make two real modes of the short period.
#[test]
fn the_matrix_e_takes_derivatives_by_the_rate() {
    let aerosonde = Airframe::aerosonde();
    let flight = SteadyFlight { airspeed: 40.0, climb_angle: 4.0_f64.to_radians() };
    let trim = aerosonde.trim(&flight).expect("it flies");
    let right = aerosonde.longitudinal(&trim).expect("derivatives");
    let mut printed = right.descriptor();
    printed.e[(0, 0)] = right.airspeed - right.z_alpha;
    printed.e[(1, 0)] = -right.m_alpha;
    let modes = |a: &Matrix4<f64>| {
        let mut modes = eigenvalues(a).expect("finite").map(|pole| (pole.re, pole.im.abs()));
        modes.sort_by(|a, b| a.0.hypot(a.1).total_cmp(&b.0.hypot(b.1)));
        modes
    };
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 0.01, "{found}");
    let right = modes(&right.descriptor().resolve().expect("E has an inverse").a);
    near(right[3].0, -2.22);
    near(right[3].1, 5.79);
    let printed = modes(&printed.resolve().expect("E has an inverse").a);
    assert!(
        printed.iter().any(|mode| mode.1 == 0.0 && (mode.0 + 8.30).abs() < 0.01),
        "{printed:?}"
    );
    assert!(
        printed.iter().any(|mode| mode.1 == 0.0 && (mode.0 + 1.01).abs() < 0.01),
        "{printed:?}"
    );
}

/// (3.1.25): the row for the eastward velocity is not a row of a rotation matrix.
#[test]
fn a_row_of_a_rotation_has_length_one() {
    let [(sin_phi, cos_phi), (sin_theta, cos_theta), (sin_psi, cos_psi)] =
        [0.3_f64, 0.2, 0.7].map(f64::sin_cos);
    let printed = Vector3::new(
        cos_theta * sin_psi,
        cos_theta * cos_psi + sin_phi * sin_theta * cos_psi,
        -sin_theta * cos_psi + cos_phi * sin_theta * sin_psi,
    );
    let right = Vector3::new(
        cos_theta * sin_psi,
        cos_phi * cos_psi + sin_phi * sin_theta * sin_psi,
        -sin_phi * cos_psi + cos_phi * sin_theta * sin_psi,
    );
    assert!((right.norm() - 1.0).abs() < 1e-15);
    println!("(3.1.25) the row of the way east has length {:.3} as printed", printed.norm());
    assert!((printed.norm() - 1.0).abs() > 0.01);
}

/// (4.6): pairing y of one sample with x̂ of the one before creates an error where there is none.
#[test]
fn the_update_pairs_samples_that_are_not_of_one_time() {
    let plant = Plant::P2.discrete(INTERVAL_S);
    let q = plant.b * plant.b.transpose() * 1e-2;
    let gain =
        riccati(&plant.a, &full_state(), &q, &Matrix4::identity()).expect("a gain").filter_gain;
    let (mut x, mut estimate) = (SVector::from(START), SVector::from(START));
    let mut worst = SVector::<f64, 4>::zeros();
    for sample in 0..1000 {
        let u = Inputs::Constant.at(sample);
        x = plant.a * x + plant.b * u;
        estimate = plant.a * estimate + plant.b * u + gain * (x - estimate);
        worst = worst.sup(&(x - estimate).abs());
    }
    println!("(4.6) from the right start, without noise: wrong by up to {worst}");
    assert!(worst[2] > 0.01 && worst[1] > 0.001);
}

/// (4.7): without C P Cᵀ in the inverse a variance becomes negative.
#[test]
fn the_covariance_update_lacks_what_it_divides_by() {
    let plant = Plant::P2.discrete(INTERVAL_S);
    let p = Matrix4::from_diagonal(&SVector::from([0.01, 0.01, 25.0, 0.01]));
    let printed = plant.a * p * plant.a.transpose() + Noise::SENSORS.process(&plant)
        - plant.a * p * p * plant.a.transpose();
    println!("(4.7) makes of a variance of 25 m²/s² one of {:.0}", printed[(2, 2)]);
    assert!(printed[(2, 2)] < -500.0);
}

/// The determinant of the observability matrix is nearly zero for an aircraft whose every mode is observable.
#[test]
fn a_determinant_is_no_test() {
    let theta = RowVector4::new(0.0, 0.0, 0.0, 1.0);
    for (interval, most) in [(1e-2, 1e-11), (1e-3, 1e-17)] {
        let model = Plant::P2.model();
        let a = zero_order_hold(&model.a, &model.b, interval).expect("an interval").a;
        let rows = [theta, theta * a, theta * a * a, theta * a * a * a];
        let determinant = Matrix4::from_rows(&rows).determinant();
        println!("det O from θ at {interval} s: {determinant:.1e}");
        assert!(determinant.abs() < most);
        assert!(kestirim_observer_design::observability(&a, &theta).is_ok());
    }
}
