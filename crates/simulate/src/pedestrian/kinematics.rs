//! What a perfect IMU measures along a moving pose.

use kestirim_replay::metrics::STANDARD_GRAVITY;
use kestirim_replay::pedestrian::Sample;
use nalgebra::Vector3;

use super::gait::Pose;

/// The longest step of the numerical differentiation, s.
const FINE_STEP_S: f64 = 1e-3;

/// Samples of a perfect IMU whose anti-alias filter averages over the sampling period: a sample at
/// time `t` is the mean since the sample before.
pub fn ideal_imu(pose: impl Fn(f64) -> Pose, duration_s: f64, rate_hz: f64) -> Vec<Sample> {
    let period_s = 1.0 / rate_hz;
    let steps = (period_s / FINE_STEP_S).ceil().max(1.0);
    let step_s = period_s / steps;
    let samples = 1..=(duration_s * rate_hz).floor() as u64;
    samples
        .map(|index| {
            let start_s = (index - 1) as f64 * period_s;
            let fine = (0..steps as u32)
                .map(|step| motion(&pose, start_s + f64::from(step) * step_s, step_s));
            let (force, rate) = fine
                .fold((Vector3::zeros(), Vector3::zeros()), |(forces, rates), (force, rate)| {
                    (forces + force, rates + rate)
                });
            Sample {
                time_us: (index as f64 * period_s * 1e6).round() as u64,
                specific_force: (force / steps).into(),
                angular_rate: (rate / steps).into(),
            }
        })
        .collect()
}

/// The specific force, m/s², and angular rate, rad/s, both in the body frame, between `t` and `t + step`.
///
/// The rate is that of the single rotation from one attitude to the other, so it integrates back without error; the
/// acceleration is the second difference of the position.
fn motion(pose: &impl Fn(f64) -> Pose, t: f64, step: f64) -> (Vector3<f64>, Vector3<f64>) {
    let half = step / 2.0;
    let [before, middle, after] = [pose(t), pose(t + half), pose(t + step)];
    let rate = before.attitude.rotation_to(&after.attitude);
    let rate = (before.attitude.inverse() * rate * before.attitude).scaled_axis() / step;
    let acceleration = (after.position - 2.0 * middle.position + before.position) / (half * half);
    let force = acceleration + Vector3::z() * STANDARD_GRAVITY;
    (middle.attitude.inverse() * force, rate)
}
