//! The common scenario by which filters are compared: position and velocity in the plane, and every 0.1 s
//! ranges to the four corners of a room of 10 m × 8 m. A step is a prediction and four updates.

use kestirim_adaptive_kalman::{
    AdaptiveKalman, Learning, MeasurementNoise, PrintedAdaptiveKalman, ProcessNoise,
};
use kestirim_kalman::{ConstantVelocity, Covariance, Gaussian, SparseRow};
use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::{ExpectedRange, expected_range};
use nalgebra::{SMatrix, SVector};
use support::Class;

use crate::replay::Tracker;
use crate::stream::Ranges;

const INTERVAL: f64 = 0.1;
/// (0.5 m/s^1.5)².
const ACCELERATION_DENSITY: f64 = 0.25;
const RANGE_VARIANCE: f64 = 0.01;

/// What a scalar is called in tables.
pub trait Named: Scalar {
    /// The name.
    const NAME: &str;
}

impl Named for f32 {
    const NAME: &str = "f32";
}

impl Named for kestirim_scalar::Q12_20 {
    const NAME: &str = "q12.20";
}

impl Named for kestirim_scalar::Q16_16 {
    const NAME: &str = "q16.16";
}

fn anchors<T: Scalar>() -> [SVector<T, 3>; 4] {
    [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 8.0, 0.0], [0.0, 8.0, 0.0]]
        .map(|place| SVector::from(place.map(T::from_f64)))
}

fn start<T: Scalar>() -> Gaussian<T, 4> {
    let mean = SVector::from([5.0, 4.0, 0.0, 0.0].map(T::from_f64));
    Gaussian::new(mean, Covariance::from_variances(&[T::ONE; 4]))
}

fn motion<T: Scalar>(density: f64) -> ConstantVelocity<T, 2> {
    ConstantVelocity::new(T::from_f64(INTERVAL), T::from_f64(density))
}

#[inline(always)]
fn expected<T: Scalar>(mean: &SVector<T, 4>, anchor: &SVector<T, 3>) -> ExpectedRange<T, 2> {
    let [x, y, ..] = mean.data.0[0];
    expected_range(&SVector::from([x, y]), T::ZERO, anchor)
}

fn place<T: Scalar>(estimate: &Gaussian<T, 4>) -> [f32; 3] {
    let [x, y, ..] = estimate.mean.data.0[0].map(T::to_f32);
    [x, y, 0.0]
}

/// The extended Kalman filter.
pub struct Ekf<T: Scalar> {
    anchors: [SVector<T, 3>; 4],
    estimate: Gaussian<T, 4>,
}

impl<T: Scalar> Default for Ekf<T> {
    fn default() -> Self {
        Self { anchors: anchors(), estimate: start() }
    }
}

impl<T: Named> Tracker for Ekf<T> {
    const NAME: &str = "ekf4-ranges4";
    const SCALAR: &str = T::NAME;
    type Record = Ranges;
    type Input = [T; 4];

    fn input(record: &Ranges) -> [T; 4] {
        record.ranges.map(T::from_f32)
    }

    #[inline(always)]
    fn step(&mut self, ranges: &[T; 4]) -> Class {
        if self.estimate.advance(&motion(ACCELERATION_DENSITY)).is_err() {
            return Class::Rejected;
        }
        for (anchor, &range) in self.anchors.iter().zip(ranges) {
            let ExpectedRange { distance, direction: [x, y] } =
                expected(&self.estimate.mean, anchor);
            let row = SparseRow::new([(0, x), (1, y)]);
            let variance = T::from_f64(RANGE_VARIANCE);
            if self.estimate.update(&row, range - distance, variance).is_err() {
                return Class::Rejected;
            }
        }
        Class::Update
    }

    fn position(&self) -> [f32; 3] {
        place(&self.estimate)
    }
}

#[inline(always)] // So that the constants fold.
fn learning<T: Scalar>(least: f64, most: f64) -> Learning<T> {
    match Learning::new(T::from_f64(0.95), T::from_f64(least), T::from_f64(most)) {
        Ok(learning) => learning,
        Err(_) => support::fail("limits that make sense"),
    }
}

/// The adaptive filter in its safe form: both adaptations.
pub struct Aekf<T: Scalar> {
    anchors: [SVector<T, 3>; 4],
    filter: AdaptiveKalman<T, 4, 4>,
}

impl<T: Scalar> Default for Aekf<T> {
    fn default() -> Self {
        let (position, velocity) = (learning(1e-5, 1e-2), learning(1e-3, 1e-1));
        let (p, v) = (T::from_f64(1e-4), T::from_f64(2.5e-2));
        let process = ProcessNoise::new([p, p, v, v], [position, position, velocity, velocity]);
        let noise = MeasurementNoise::new(T::from_f64(RANGE_VARIANCE), learning(2.5e-3, 4.0));
        Self { anchors: anchors(), filter: AdaptiveKalman::new(start(), process, [noise; 4]) }
    }
}

impl<T: Named> Tracker for Aekf<T> {
    const NAME: &str = "aekf4-ranges4";
    const SCALAR: &str = T::NAME;
    type Record = Ranges;
    type Input = [T; 4];

    fn input(record: &Ranges) -> [T; 4] {
        record.ranges.map(T::from_f32)
    }

    #[inline(always)]
    fn step(&mut self, ranges: &[T; 4]) -> Class {
        if self.filter.predict(&motion(0.0)).is_err() {
            return Class::Rejected;
        }
        for (index, (anchor, &range)) in self.anchors.iter().zip(ranges).enumerate() {
            let ExpectedRange { distance, direction: [x, y] } =
                expected(&self.filter.estimate().mean, anchor);
            let row = SparseRow::new([(0, x), (1, y)]);
            if self.filter.update(index, &row, range - distance).is_err() {
                return Class::Rejected;
            }
        }
        Class::Update
    }

    fn position(&self) -> [f32; 3] {
        place(self.filter.estimate())
    }
}

/// The adaptive filter as the paper prints it, with constants that keep its R positive.
pub struct Printed<T: Scalar> {
    anchors: [SVector<T, 3>; 4],
    filter: PrintedAdaptiveKalman<T, 4, 4>,
}

impl<T: Scalar> Default for Printed<T> {
    fn default() -> Self {
        let forgetting = T::from_f64(0.95);
        let (q, r) = ([T::from_f64(3e-5); 4], [T::from_f64(0.1); 4]);
        let mut start = start();
        start.covariance = Covariance::from_variances(&[1e-4, 1e-4, 0.0, 0.0].map(T::from_f64));
        let filter = PrintedAdaptiveKalman::new(
            start,
            Covariance::from_variances(&q),
            Covariance::from_variances(&r),
            forgetting,
            forgetting,
        );
        match filter {
            Ok(filter) => Self { anchors: anchors(), filter },
            Err(_) => support::fail("factors that make sense"),
        }
    }
}

impl<T: Named> Tracker for Printed<T> {
    const NAME: &str = "aekf4-printed";
    const SCALAR: &str = T::NAME;
    type Record = Ranges;
    type Input = [T; 4];

    fn input(record: &Ranges) -> [T; 4] {
        record.ranges.map(T::from_f32)
    }

    #[inline(always)]
    fn step(&mut self, ranges: &[T; 4]) -> Class {
        if self.filter.predict(&motion(0.0)).is_err() {
            return Class::Rejected;
        }
        let mean = self.filter.estimate().mean;
        let mut rows = SMatrix::<T, 4, 4>::zeros();
        let mut innovation = SVector::<T, 4>::zeros();
        for (index, (anchor, &range)) in self.anchors.iter().zip(ranges).enumerate() {
            let ExpectedRange { distance, direction: [x, y] } = expected(&mean, anchor);
            innovation.data.0[0][index] = range - distance;
            rows.data.0[0][index] = x;
            rows.data.0[1][index] = y;
        }
        if self.filter.update(&rows, &innovation).is_ok() { Class::Update } else { Class::Rejected }
    }

    fn position(&self) -> [f32; 3] {
        place(self.filter.estimate())
    }
}
