//! A synthetic foot: it stands, swings forwards over a smooth arc while it pitches, and stands again.

use kestirim_attitude::Orientation;
use kestirim_pedestrian::ImuSample;
use kestirim_scalar::Scalar;
use nalgebra::{SVector, Vector3};

const GRAVITY: f64 = 9.80665;
const STAND: f64 = 0.5;
const SWING: f64 = 0.6;

/// The walker's motion and the sensor's errors.
#[derive(Clone)]
pub(crate) struct Foot {
    /// The length of a stride (m).
    pub(crate) stride: f64,
    /// The heading of each stride (rad).
    pub(crate) headings: Vec<f64>,
    /// The pitch of the foot in a swing (rad).
    pub(crate) pitch: f64,
    /// The sampling rate (Hz).
    pub(crate) rate: f64,
    /// The gyro bias (rad/s, body).
    pub(crate) bias: Vector3<f64>,
    /// The peak of a deterministic noise: in m/s², and a tenth of it in rad/s.
    pub(crate) noise: f64,
}

impl Default for Foot {
    fn default() -> Self {
        Self {
            stride: 1.2,
            headings: vec![0.0; 10],
            pitch: 0.8,
            rate: 100.0,
            bias: Vector3::zeros(),
            noise: 0.0,
        }
    }
}

impl Foot {
    /// The duration of the walk (s): 2 s of standing, the strides, 1 s of standing.
    pub(crate) fn duration(&self) -> f64 {
        3.0 + self.headings.len() as f64 * (STAND + SWING)
    }

    /// The position (m) and rotation vector (rad) at a time, earth.
    fn pose(&self, t: f64) -> (Vector3<f64>, f64, f64) {
        let mut position = Vector3::zeros();
        let mut heading = self.headings.first().copied().unwrap_or(0.0);
        let mut begun = 2.0;
        for &towards in &self.headings {
            let phase = ((t - begun) / SWING).clamp(0.0, 1.0);
            // A polynomial whose first three derivatives vanish at both ends.
            let s = phase.powi(4) * (35.0 + phase * (-84.0 + phase * (70.0 - 20.0 * phase)));
            position += Vector3::new(towards.cos(), towards.sin(), 0.0) * (self.stride * s);
            heading += (towards - heading) * s;
            if phase > 0.0 && phase < 1.0 {
                let lift = 256.0 * (phase * (1.0 - phase)).powi(4);
                position.z += 0.1 * lift;
                return (position, heading, -self.pitch * lift * (1.0 - 2.0 * phase));
            }
            begun += SWING + STAND;
        }
        (position, heading, 0.0)
    }

    fn orientation(&self, t: f64) -> Orientation<f64> {
        let (_, heading, pitch) = self.pose(t);
        Orientation::identity()
            .turned_in_earth(&Vector3::new(0.0, pitch, 0.0))
            .turned_in_earth(&Vector3::new(0.0, 0.0, heading))
    }

    /// The samples that the IMU measures, exact except for the configured noise.
    pub(crate) fn samples<T: Scalar>(&self) -> Vec<ImuSample<T>> {
        let steps = (self.duration() * self.rate) as u64;
        (1..=steps).map(|k| self.sample(k)).collect()
    }

    fn sample<T: Scalar>(&self, k: u64) -> ImuSample<T> {
        const H: f64 = 1e-3;
        // The mean over the sampling period, as a sensor with an anti-alias filter delivers.
        let t = (k as f64 - 0.5) / self.rate;
        let position = |t: f64| self.pose(t).0;
        let acceleration = (position(t + H) - 2.0 * position(t) + position(t - H)) / (H * H);
        let now = self.orientation(t);
        let force = now.to_body(&(acceleration + Vector3::new(0.0, 0.0, GRAVITY)));
        let (before, after) = (self.orientation(t - H), self.orientation(t + H));
        let axis = |v: Vector3<f64>| {
            now.to_body(&((after.to_earth(&v) - before.to_earth(&v)) / (2.0 * H)))
        };
        let (x, y) = (axis(Vector3::x()), axis(Vector3::y()));
        let rate = Vector3::new(y.z, -x.z, x.y);
        let wobble = |m: u64| ((k * m % 1009) as f64 / 504.0 - 1.0) * self.noise;
        let noise = Vector3::new(wobble(379), wobble(521), wobble(733));
        ImuSample {
            time_us: (k as f64 * 1e6 / self.rate).round() as u64,
            specific_force: cast(force + noise),
            angular_rate: cast(rate + self.bias + noise.yzx() * 0.1),
        }
    }
}

fn cast<T: Scalar>(v: Vector3<f64>) -> SVector<T, 3> {
    v.map(T::from_f64)
}
