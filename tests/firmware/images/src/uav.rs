//! An unmanned aeroplane with sensors for airspeed, pitch rate and pitch, and the gain that places its observer's
//! poles, computed at compile time. The host's tests include this file.

use kestirim_luenberger::{Plant, PredictorGains};
use nalgebra::{Matrix3x4, Matrix4, Matrix4x2, Matrix4x3};

/// The dynamics of the continuous plant P2; the states are angle of attack (rad), pitch rate (rad/s), airspeed (m/s),
/// pitch (rad).
pub const A: Matrix4<f64> = Matrix4::new(
    -1.79,
    1.0,
    -0.0076,
    -0.017_107_775_185_746_733, //
    -25.0,
    -20.0,
    -0.02,
    0.0, //
    2.0,
    0.0,
    -0.0267,
    -9.786_103_333_048_876, //
    0.0,
    1.0,
    0.0,
    0.0,
);
/// The input matrix; the inputs are elevator (rad) and throttle.
pub const B: Matrix4x2<f64> = Matrix4x2::new(0.3, -0.158, -100.0, -3.0, 0.3, 45.0, 0.0, 0.0);
/// The output matrix; the outputs are pitch rate, airspeed and pitch.
pub const C: Matrix3x4<f64> =
    Matrix3x4::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
/// Poles of the observer, 1/s.
pub const POLES: [f64; 4] = [-3.0, -3.5, -4.0, -4.5];
/// The initial state of the observer.
pub const START: [f32; 4] = [0.1, 0.1, 35.0, 0.4];

/// The discrete plant over an interval (s) with held inputs, by the series of the exponential.
pub const fn plant(interval: f64) -> Plant<4, 2, 3> {
    let (mut a, mut b) =
        (Matrix4::new(1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.), B);
    let (mut term_a, mut term_b) = (a, B);
    scale(&mut b.data.0, interval);
    scale(&mut term_b.data.0, interval);
    let mut order = 1;
    while order < 20 {
        term_a.data.0 = product(&A.data.0, &term_a.data.0);
        term_b.data.0 = product(&A.data.0, &term_b.data.0);
        scale(&mut term_a.data.0, interval / order as f64);
        scale(&mut term_b.data.0, interval / (order + 1) as f64);
        add(&mut a.data.0, &term_a.data.0);
        add(&mut b.data.0, &term_b.data.0);
        order += 1;
    }
    Plant { a, b, c: C }
}

/// The predictor gain L.
///
/// Only the first column of A − L C is given by the plant. The other three are chosen so that pitch rate and angle of
/// attack form a pair of poles, and airspeed and pitch have one pole each.
pub const fn gain(plant: &Plant<4, 2, 3>, interval: f64) -> Matrix4x3<f64> {
    let [p0, p1, p2, p3] = [
        exp(POLES[0] * interval),
        exp(POLES[1] * interval),
        exp(POLES[2] * interval),
        exp(POLES[3] * interval),
    ];
    let [alpha, rate, airspeed, pitch] = plant.a.data.0;
    let own = p0 + p1 - alpha[0];
    let across = (alpha[0] * own - p0 * p1) / alpha[1];
    Matrix4x3::new(
        rate[0] - across,
        airspeed[0],
        pitch[0], //
        rate[1] - own,
        airspeed[1],
        pitch[1], //
        rate[2],
        airspeed[2] - p2,
        pitch[2], //
        rate[3],
        airspeed[3],
        pitch[3] - p3,
    )
}

/// The predictor's coefficients for an interval (s).
pub const fn gains(interval: f64) -> PredictorGains<4, 2, 3> {
    let plant = plant(interval);
    PredictorGains::new(&plant, &gain(&plant, interval))
}

/// The exponential eˣ of a small x, by its series.
pub const fn exp(x: f64) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    let mut order = 1;
    while order < 20 {
        term *= x / order as f64;
        sum += term;
        order += 1;
    }
    sum
}

const fn product<const C: usize>(a: &[[f64; 4]; 4], b: &[[f64; 4]; C]) -> [[f64; 4]; C] {
    let mut product = [[0.0; 4]; C];
    let mut index = 0;
    while index < C * 16 {
        let (column, row, k) = (index / 16, index / 4 % 4, index % 4);
        product[column][row] += a[k][row] * b[column][k];
        index += 1;
    }
    product
}

const fn scale<const C: usize>(a: &mut [[f64; 4]; C], factor: f64) {
    let mut index = 0;
    while index < C * 4 {
        a[index / 4][index % 4] *= factor;
        index += 1;
    }
}

const fn add<const C: usize>(a: &mut [[f64; 4]; C], b: &[[f64; 4]; C]) {
    let mut index = 0;
    while index < C * 4 {
        a[index / 4][index % 4] += b[index / 4][index % 4];
        index += 1;
    }
}
