//! The common scenario on which filters are compared: position and velocity in the plane, and every 0.1 s ranges to the
//! four corners of a room of 10 m × 8 m. A step is a prediction and four updates.

mod adaptive;
mod robust;

use core::hint::black_box;

use kestirim_kalman::{ConstantVelocity, Covariance, Gaussian, Innovation, SparseRow};
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::{ExpectedRange, expected_range};
use nalgebra::SVector;
use support::Class;

use crate::replay::Tracker;
use crate::stream::Ranges;
pub use adaptive::{Aekf, Published};
pub use robust::Robust;

/// A scalar with a name for tables.
pub trait Named: Scalar {
    /// The name for tables.
    const NAME: &str;
}

impl Named for f32 {
    const NAME: &str = "f32";
}

impl Named for kestirim_scalar::Q12_20 {
    const NAME: &str = "q12.20";
}

impl Named for kestirim_scalar::Q8_24 {
    const NAME: &str = "q8.24";
}

impl Named for kestirim_scalar::Q16_16 {
    const NAME: &str = "q16.16";
}

/// The scenario's parameters, hidden from the optimiser: firmware reads them from a configuration, and a filter
/// specialised for one interval and noise would look cheaper than it is.
pub struct Scenario<T: Scalar> {
    /// The positions of the anchors, m.
    pub anchors: [SVector<T, 3>; 4],
    /// The time between steps, s.
    pub interval: T,
    /// The power spectral density of the acceleration, m²/s³.
    pub acceleration_density: T,
    /// The variance of a range, m².
    pub range_variance: T,
    /// The initial estimate: m, m, m/s, m/s.
    pub start: [T; 4],
    /// The variance of each state of the initial estimate.
    pub start_variance: T,
}

impl<T: Scalar> Default for Scenario<T> {
    fn default() -> Self {
        // In micrometres and the like: `from_f64` uses double precision unless it is folded at compile time.
        let place = |x, y| SVector::from([T::from_micro(x), T::from_micro(y), T::ZERO]);
        black_box(Self {
            anchors: [
                place(0, 0),
                place(10_000_000, 0),
                place(10_000_000, 8_000_000),
                place(0, 8_000_000),
            ],
            interval: T::from_micro(100_000),
            // (0.5 m/s^1.5)².
            acceleration_density: T::from_micro(250_000),
            range_variance: T::from_micro(10_000),
            start: [T::from_micro(5_000_000), T::from_micro(4_000_000), T::ZERO, T::ZERO],
            start_variance: T::ONE,
        })
    }
}

impl<T: Scalar> Scenario<T> {
    /// The expected range to an anchor.
    #[inline(always)]
    pub fn expected(&self, &[x, y, ..]: &[T; 4], anchor: &SVector<T, 3>) -> ExpectedRange<T, 2> {
        expected_range(&SVector::from([x, y]), T::ZERO, anchor)
    }

    fn estimate(&self) -> Gaussian<T, 4> {
        let covariance = Covariance::from_variances(&[self.start_variance; 4]);
        Gaussian::new(SVector::from(self.start), covariance)
    }

    fn motion(&self) -> ConstantVelocity<T, 2> {
        ConstantVelocity::new(self.interval, self.acceleration_density)
    }

    /// The motion model for filters that estimate their process noise themselves.
    fn steady(&self) -> ConstantVelocity<T, 2> {
        ConstantVelocity::new(self.interval, T::ZERO)
    }
}

/// F and Q of the scenario as matrices, row by row, for filters that need them in this form.
pub fn transition<T: Scalar>(scenario: &Scenario<T>) -> [[[T; 4]; 4]; 2] {
    let (h, q) = (scenario.interval, scenario.acceleration_density);
    let (o, i) = (T::ZERO, T::ONE);
    let (position, cross) = (q * h * h * h * T::from_f64(1.0 / 3.0), q * h * h * T::HALF);
    let f = [[i, o, h, o], [o, i, o, h], [o, o, i, o], [o, o, o, i]];
    let q = [
        [position, o, cross, o],
        [o, position, o, cross],
        [cross, o, q * h, o],
        [o, cross, o, q * h],
    ];
    [f, q]
}

fn place<T: Scalar>(estimate: &Gaussian<T, 4>) -> [f32; 3] {
    let [x, y, ..] = estimate.mean.as_array().map(T::to_f32);
    [x, y, 0.0]
}

/// The extended Kalman filter.
pub struct Ekf<T: Scalar> {
    scenario: Scenario<T>,
    estimate: Gaussian<T, 4>,
    /// The innovations of the last step's ranges: applications that monitor a filter read the normalised innovations.
    innovations: [Option<Innovation<T>>; 4],
}

impl<T: Scalar> Default for Ekf<T> {
    fn default() -> Self {
        let scenario = Scenario::default();
        let estimate = scenario.estimate();
        Self { scenario, estimate, innovations: [None; 4] }
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
        if self.estimate.advance(&self.scenario.motion()).is_err() {
            return Class::Rejected;
        }
        let places = self.scenario.anchors.iter().zip(ranges);
        for ((anchor, &range), told) in places.zip(&mut self.innovations) {
            let ExpectedRange { distance, direction: [x, y] } =
                self.scenario.expected(self.estimate.mean.as_array(), anchor);
            let row = SparseRow::new([(0, x), (1, y)]);
            match self.estimate.update(&row, range - distance, self.scenario.range_variance) {
                Ok(innovation) => *told = Some(innovation),
                Err(_) => return Class::Rejected,
            }
        }
        Class::Update
    }

    fn position(&self) -> [f32; 3] {
        place(&self.estimate)
    }
}
