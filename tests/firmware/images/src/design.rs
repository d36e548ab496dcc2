//! The aeroplane's gains at 100 Hz, designed when the program starts. The host's tests include this file.

use core::hint::black_box;

use kestirim_observer_design::{
    Complex, Discrete, Error, Placement, Riccati, place, riccati, zero_order_hold,
};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use crate::uav::{A, B, C, POLES, exp};

/// The sampling interval, s.
const INTERVAL: f64 = 0.01;
/// The standard deviations of the noise on elevator and throttle.
const INPUT_NOISE: Vector2<f64> = Vector2::new(0.0087, 0.02);
/// The standard deviations of the noise on pitch rate, airspeed and pitch.
const OUTPUT_NOISE: Vector3<f64> = Vector3::new(0.0087, 0.5, 0.0087);

/// The discrete plant.
///
/// # Errors
/// Never.
pub fn held() -> Result<Discrete<4, 2>, Error> {
    zero_order_hold(&black_box(A), &B, INTERVAL)
}

/// The gain that places the observer's poles.
///
/// # Errors
/// Never, for this discrete plant.
pub fn placed(plant: &Discrete<4, 2>) -> Result<Placement<4, 3>, Error> {
    place(&plant.a, &C, &POLES.map(|pole| Complex { re: exp(pole * INTERVAL), im: 0.0 }))
}

/// The steady-state Kalman gain.
///
/// # Errors
/// Never, for this discrete plant.
pub fn settled(plant: &Discrete<4, 2>) -> Result<Riccati<4, 3>, Error> {
    let inputs = Matrix2::from_diagonal(&INPUT_NOISE.component_mul(&INPUT_NOISE));
    let outputs = Matrix3::from_diagonal(&OUTPUT_NOISE.component_mul(&OUTPUT_NOISE));
    riccati(&plant.a, &C, &(plant.b * inputs * plant.b.transpose()), &outputs)
}
