//! An aircraft that is flown through 3-2-1-1 inputs and doublets of the throttle, with noise of air and sensors.

use kestirim_uav_identification::Flight;
use nalgebra::{Matrix4, SMatrix, Vector2, Vector4};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

pub(crate) const STEP_S: f64 = 0.02;
const GRAVITY: f64 = 9.806_65;
const AIRSPEED: f64 = 20.0;
/// Number of integration steps between two samples.
const FINE: usize = 10;

/// Derivatives of α̇, q̇, V̇ with respect to α, q, V, δe, δt; `Z_q` without the kinematic 1.
pub(crate) const TRUE: [[f64; 5]; 3] = [
    [-4.0, -0.03, -0.045, -0.2, 0.0],
    [-40.0, -5.0, 0.1, -35.0, -1.0],
    [4.0, 0.0, -0.25, -0.5, 5.0],
];

/// The parameters of a flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    pub(crate) seconds: f64,
    pub(crate) seed: u64,
    /// Noise on ẋ, per √Hz.
    pub(crate) gusts: [f64; 4],
    /// Added to `X_V`: above 0.25 the phugoid is unstable.
    pub(crate) lively: f64,
    pub(crate) throttle: bool,
}

pub(crate) const CALM: Plan =
    Plan { seconds: 60.0, seed: 1, gusts: [0.0; 4], lively: 0.0, throttle: true };

/// A 3-2-1-1 of the elevator every 20 s, with a doublet of the throttle in between.
fn input(time: f64, plan: &Plan) -> Vector2<f64> {
    let at = time % 20.0;
    let sign = if (time / 20.0) as i64 % 2 == 0 { 1.0 } else { -1.0 };
    let unit = 0.3;
    let elevator = match ((at - 1.0) / unit).floor() {
        0.0..=2.0 | 5.0 => 0.05,
        3.0..=4.0 | 6.0 => -0.05,
        _ => 0.0,
    };
    let throttle = match at {
        8.0..10.0 => 0.2,
        10.0..12.0 => -0.2,
        _ => 0.0,
    };
    Vector2::new(sign * elevator, if plan.throttle { throttle } else { 0.0 })
}

/// Simulates the flight.
pub(crate) fn fly(plan: &Plan) -> Flight {
    let [z, m, x] = TRUE;
    let a = Matrix4::new(
        z[0],
        1.0 + z[1],
        z[2],
        0.0, //
        m[0],
        m[1],
        m[2],
        0.0, //
        x[0],
        0.0,
        x[2] + plan.lively,
        -GRAVITY, //
        0.0,
        1.0,
        0.0,
        0.0,
    );
    let b = SMatrix::<f64, 4, 2>::from_row_slice(&[z[3], z[4], m[3], m[4], x[3], x[4], 0.0, 0.0]);
    let trim = Vector4::new(0.07, 0.0, AIRSPEED, 0.07);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(plan.seed);
    let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
    let mut state = Vector4::zeros();
    let mut flight = Flight::default();
    let names = ["alpha", "q", "V", "theta", "az", "ax"];
    let sigmas = [2e-3, 3e-3, 0.2, 3e-3, 0.2, 0.1];
    let mut columns: [Vec<Option<f64>>; 6] = Default::default();
    for sample in 0..(plan.seconds / STEP_S) as usize {
        let time = sample as f64 * STEP_S;
        let now = input(time, plan);
        let rate = a * state + b * now;
        // Along and across the path; then along the body, which is rotated by α.
        let along = rate[2] + GRAVITY * (state[3] - state[0]).sin();
        let across = AIRSPEED * (rate[0] - state[1]) - GRAVITY * (state[3] - state[0]).cos();
        let alpha = trim[0] + state[0];
        let forces = [
            along * alpha.sin() + across * alpha.cos(),
            along * alpha.cos() - across * alpha.sin(),
        ];
        let shown = trim + state;
        let clean = [shown[0], shown[1] + 0.01, shown[2], shown[3], forces[0], forces[1]];
        for ((column, clean), sigma) in columns.iter_mut().zip(clean).zip(sigmas) {
            column.push(Some(clean + sigma * normal()));
        }
        flight.times.push(time);
        flight.inputs.push([-0.04 + now[0], 0.5 + now[1]]);
        // Held from this sample to the next.
        let fine = STEP_S / FINE as f64;
        for _ in 0..FINE {
            let middle = state + (a * state + b * now) * (0.5 * fine);
            state += (a * middle + b * now) * fine;
            for (value, gust) in state.iter_mut().zip(plan.gusts) {
                *value += gust * fine.sqrt() * normal();
            }
        }
    }
    flight.columns = names.map(str::to_owned).into_iter().zip(columns).collect();
    flight
}
