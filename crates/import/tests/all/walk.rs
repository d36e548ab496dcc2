//! A synthetic walk of a foot: it stands, lifts its heel, swings, stands again, and turns now and then.

use std::f64::consts::{PI, TAU};

/// Samples per second, Hz.
pub(crate) const RATE: f64 = 100.0;

/// Rows of t, ax, ay, az, gx, gy, gz in s, m/s², rad/s, over `strides` strides, as an obliquely mounted sensor gives
/// them.
pub(crate) fn rows(strides: usize) -> Vec<[f64; 7]> {
    let stride = 120;
    let count = 200 + strides * stride;
    (0..count).map(|i| row(i as f64 / RATE)).collect::<Vec<_>>()
}

/// Pitch, roll and yaw, rad, and the position, m, at a time.
fn pose(t: f64) -> ([f64; 3], [f64; 3]) {
    let phase = (t - 2.0).max(0.0) / 1.2;
    let (stride, part) = (phase.floor(), phase.fract());
    // The swing is the last half of a stride; smooth to the third derivative.
    let swing = ((part - 0.5) / 0.5).max(0.0);
    let eased = swing - (TAU * swing).sin() / TAU;
    let pitch = 0.9 * (PI * eased).sin() * (TAU * eased).sin();
    let roll = 0.15 * (PI * eased).sin().powi(2);
    let yaw = 0.4 * (stride + eased);
    let forward = 1.3 * (stride + eased);
    let height = 0.12 * (PI * eased).sin().powi(2);
    ([pitch, roll, yaw], [forward, 0.1 * eased * (1.0 - eased), height])
}

/// The rotation from the body to the room.
fn turn([pitch, roll, yaw]: [f64; 3]) -> [[f64; 3]; 3] {
    let about = |axis: usize, angle: f64| {
        let (s, c) = angle.sin_cos();
        let mut m = [[0.0; 3]; 3];
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        (m[axis][axis], m[j][j], m[j][k], m[k][j], m[k][k]) = (1.0, c, -s, s, c);
        m
    };
    let mounted = product(about(1, 0.5), about(0, -0.3));
    product(product(product(about(2, yaw), about(1, pitch)), about(0, roll)), mounted)
}

fn product(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let entry = |i: usize, j: usize| (0..3).map(|k| a[i][k] * b[k][j]).sum::<f64>();
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

fn transposed(a: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

fn row(t: f64) -> [f64; 7] {
    const STEP: f64 = 1e-4;
    let [before, now, after] = [t - STEP, t, t + STEP].map(pose);
    let turns = [before.0, now.0, after.0].map(turn);
    let mut specific_force = [0.0; 3];
    for axis in 0..3 {
        specific_force[axis] = (before.1[axis] - 2.0 * now.1[axis] + after.1[axis]) / (STEP * STEP);
    }
    specific_force[2] += 9.806_65;
    let force: [f64; 3] =
        std::array::from_fn(|i| (0..3).map(|k| turns[1][k][i] * specific_force[k]).sum());
    // RᵀR' is the cross-product matrix of the rate.
    let change: [[f64; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|j| (turns[2][i][j] - turns[0][i][j]) / (2.0 * STEP))
    });
    let cross = product(transposed(turns[1]), change);
    // Deterministic noise.
    let noise = |seed: f64| ((t * 977.0 + seed) * 12.9898).sin() * 43_758.545 % 1.0 - 0.0;
    [
        t,
        force[0] + 0.01 * noise(1.0),
        force[1] + 0.01 * noise(2.0),
        force[2] + 0.01 * noise(3.0),
        cross[2][1] + 0.002 * noise(4.0),
        cross[0][2] + 0.002 * noise(5.0),
        cross[1][0] + 0.002 * noise(6.0),
    ]
}
