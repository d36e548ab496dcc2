//! Sensors with known errors, and noise.

#![allow(dead_code)] // Each test needs a part of it.

use kestirim_imu_calibration::{Gyroscope, Pose, Poses, Triad, Turn};
use kestirim_scalar::Scalar;
use nalgebra::{Matrix3, Rotation3, SVector, UnitVector3, Vector3};

pub(crate) const GRAVITY: f64 = 9.80665;

/// Reproducible normal noise: a sum of twelve numbers of Vigna's splitmix64.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) as f64 / u64::MAX as f64
    }

    pub(crate) fn normal(&mut self, sigma: f64) -> f64 {
        ((0..12).map(|_| self.uniform()).sum::<f64>() - 6.0) * sigma
    }

    pub(crate) fn vector(&mut self, sigma: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.normal(sigma))
    }

    pub(crate) fn direction(&mut self) -> UnitVector3<f64> {
        UnitVector3::new_normalize(self.vector(1.0))
    }
}

pub(crate) fn cast<T: Scalar>(v: &Vector3<f64>) -> SVector<T, 3> {
    v.map(T::from_f64)
}

/// The reading of a sensor whose correction is the triad.
pub(crate) fn measured(triad: &Triad<f64>, truth: &Vector3<f64>) -> Vector3<f64> {
    triad.matrix.try_inverse().expect("a sensor") * truth + triad.offset
}

pub(crate) fn accelerometer() -> Triad<f64> {
    let matrix = Matrix3::new(0.98, 0.012, -0.008, 0.0, 1.025, 0.01, 0.0, 0.0, 1.01);
    Triad { offset: Vector3::new(0.3, -0.25, 0.15), matrix }
}

pub(crate) fn gyroscope() -> Triad<f64> {
    let matrix = Matrix3::new(1.02, 0.01, -0.015, -0.012, 0.975, 0.008, 0.006, -0.01, 1.03);
    Triad { offset: Vector3::new(0.017, -0.02, 0.01), matrix }
}

/// The attitudes (sensor → earth) of the six sides, and of edges and corners between them.
pub(crate) fn attitudes(count: usize) -> Vec<Rotation3<f64>> {
    let ups = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [-1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, -1.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 1.0],
        [-1.0, 0.0, 1.0],
        [1.0, -1.0, 0.0],
        [0.0, -1.0, 1.0],
        [-1.0, 0.0, -1.0],
    ];
    let of = |up: [f64; 3]| {
        Rotation3::rotation_between(&Vector3::from(up), &Vector3::z()).unwrap_or_else(|| {
            Rotation3::from_axis_angle(&Vector3::x_axis(), core::f64::consts::PI)
        })
    };
    ups.into_iter().cycle().take(count).map(of).collect()
}

/// Poses in these attitudes, each from 200 noisy samples whose mean is additionally off by `pose_noise`.
pub(crate) fn poses<T: Scalar>(
    attitudes: &[Rotation3<f64>],
    noise: &mut Noise,
    pose_noise: f64,
) -> Poses<T, 32> {
    let mut poses = Poses::new();
    for attitude in attitudes {
        let mut pose = Pose::new();
        let up = attitude.inverse() * Vector3::z() * GRAVITY;
        let off = noise.vector(pose_noise);
        for _ in 0..200 {
            let force = measured(&accelerometer(), &up) + off + noise.vector(0.02);
            let rate = gyroscope().offset + noise.vector(0.002);
            pose.push(&cast(&force), &cast(&rate)).unwrap();
        }
        poses.add(pose).unwrap();
    }
    poses
}

/// The turns from each attitude to the next, integrated in several passes.
pub(crate) fn gyroscope_of<T: Scalar>(
    attitudes: &[Rotation3<f64>],
    accelerometer: &Triad<T>,
    bias: SVector<T, 3>,
    passes: usize,
    noise: f64,
) -> Gyroscope<T> {
    const STEPS: u32 = 150;
    let mut triad = Triad { offset: bias, ..Triad::identity() };
    let mut gyroscope_fit = Gyroscope::new(triad).unwrap();
    for pass in 0..passes {
        let mut random = Noise(5);
        gyroscope_fit = Gyroscope::new(triad).unwrap();
        for pair in attitudes.windows(2) {
            let between = pair[0].rotation_to(&pair[1]);
            // In the sensor's frame at the beginning, where the axis stays the same throughout.
            let whole = (pair[0].inverse() * between * pair[0]).scaled_axis();
            let mut turn = Turn::new(triad).unwrap();
            for _ in 0..STEPS {
                let rate = whole / (f64::from(STEPS) * 0.01);
                let rate = measured(&gyroscope(), &rate) + random.vector(noise);
                turn.push(&cast(&rate), T::from_f64(0.01)).unwrap();
            }
            let force = |attitude: &Rotation3<f64>| {
                let up = attitude.inverse() * Vector3::z() * GRAVITY;
                accelerometer.apply(&cast(&measured(&self::accelerometer(), &up)))
            };
            gyroscope_fit.add(&turn, &force(&pair[0]), &force(&pair[1])).unwrap();
        }
        if pass + 1 < passes {
            triad = gyroscope_fit.solve(T::from_f64(0.003)).unwrap().triad;
        }
    }
    gyroscope_fit
}
