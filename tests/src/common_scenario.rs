//! The common scenario on the host, as the images compute it: the extended Kalman filter, and the initial state that
//! other filters of the scenario share.

use kestirim_kalman::{ConstantVelocity, Covariance, Gaussian, SparseRow};
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::expected_range;
use nalgebra::SVector;
use target_bench::streams::ANCHORS;

/// The positions of the anchors, m.
pub fn anchors<T: Scalar>() -> [SVector<T, 3>; 4] {
    ANCHORS.map(|[x, y]| SVector::from([x, y, 0.0].map(T::from_f64)))
}

/// The initial estimate.
pub fn start<T: Scalar>() -> Gaussian<T, 4> {
    let mean = SVector::from([5.0, 4.0, 0.0, 0.0].map(T::from_f64));
    Gaussian::new(mean, Covariance::from_variances(&[T::ONE; 4]))
}

/// The motion model of one step, with white acceleration of this density (m²/s³).
pub fn motion<T: Scalar>(density: f64) -> ConstantVelocity<T, 2> {
    ConstantVelocity::new(T::from_f64(0.1), T::from_f64(density))
}

/// The measurement row and the expected value of a range.
pub fn expected<T: Scalar>(mean: &SVector<T, 4>, anchor: &SVector<T, 3>) -> (SparseRow<T, 2>, T) {
    let [x, y, ..] = *mean.as_array();
    let range = expected_range(&SVector::from([x, y]), T::ZERO, anchor);
    (SparseRow::new([(0, range.direction[0]), (1, range.direction[1])]), range.distance)
}

/// The extended Kalman filter.
#[derive(Debug)]
pub struct Ekf<T: Scalar> {
    anchors: [SVector<T, 3>; 4],
    motion: ConstantVelocity<T, 2>,
    variance: T,
    estimate: Gaussian<T, 4>,
}

impl<T: Scalar> Ekf<T> {
    /// A filter for ranges with this standard deviation (m).
    pub fn new(sigma: f64) -> Self {
        let variance = T::from_f64(sigma * sigma);
        Self { anchors: anchors(), motion: motion(0.25), variance, estimate: start() }
    }

    /// Updates with the ranges of a step (m) and returns the states after it.
    ///
    /// # Panics
    /// A range is not finite.
    pub fn step(&mut self, ranges: &[f64; 4]) -> [f64; 4] {
        self.estimate.advance(&self.motion).expect("a finite state");
        for (anchor, &measured) in self.anchors.iter().zip(ranges) {
            let (row, distance) = expected(&self.estimate.mean, anchor);
            let innovation = T::from_f64(measured) - distance;
            self.estimate.update(&row, innovation, self.variance).expect("a finite range");
        }
        self.estimate.mean.as_array().map(T::to_f64)
    }
}
