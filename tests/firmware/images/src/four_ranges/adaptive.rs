//! The common scenario with the adaptive filters.

use kestirim_adaptive_kalman::{AdaptiveKalman, Learning, ProcessNoise, PublishedAdaptiveKalman};
use kestirim_kalman::{Covariance, SparseRow};
use kestirim_scalar::{Columns, Components, Scalar};
use kestirim_uwb_ranging::ExpectedRange;
use nalgebra::{SMatrix, SVector};
use support::Class;

use super::{Named, Scenario, place};
use crate::replay::Tracker;
use crate::stream::Ranges;

#[inline(always)] // So that the constants fold.
fn learning<T: Scalar>(least: f64, most: f64) -> Learning<T> {
    match Learning::new(T::from_f64(0.95), T::from_f64(least), T::from_f64(most)) {
        Ok(learning) => learning,
        Err(_) => support::fail("limits that make sense"),
    }
}

/// The adaptive filter in its safe form, with both adaptations.
pub struct Aekf<T: Scalar> {
    scenario: Scenario<T>,
    filter: AdaptiveKalman<T, 4, 4>,
}

impl<T: Scalar> Default for Aekf<T> {
    fn default() -> Self {
        let scenario = Scenario::default();
        let (position, velocity) = (learning(1e-5, 1e-2), learning(1e-3, 1e-1));
        let (p, v) = (T::from_f64(1e-4), T::from_f64(2.5e-2));
        let process = ProcessNoise::new([p, p, v, v], [position, position, velocity, velocity]);
        let (ranges, limits) = ([scenario.range_variance; 4], [learning(2.5e-3, 4.0); 4]);
        let filter = AdaptiveKalman::new(scenario.estimate(), process, ranges, limits);
        Self { scenario, filter }
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
        if self.filter.predict(&self.scenario.steady()).is_err() {
            return Class::Rejected;
        }
        for (index, (anchor, &range)) in self.scenario.anchors.iter().zip(ranges).enumerate() {
            let ExpectedRange { distance, direction: [x, y] } =
                self.scenario.expected(self.filter.estimate().mean.as_array(), anchor);
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

/// The adaptive filter as published, with constants that keep its R positive.
pub struct Published<T: Scalar> {
    scenario: Scenario<T>,
    filter: PublishedAdaptiveKalman<T, 4, 4>,
}

impl<T: Scalar> Default for Published<T> {
    fn default() -> Self {
        let forgetting = T::from_f64(0.95);
        let (q, r) = ([T::from_f64(3e-5); 4], [T::from_f64(0.1); 4]);
        let scenario = Scenario::default();
        let mut start = scenario.estimate();
        let position = T::from_f64(1e-4);
        start.covariance = Covariance::from_variances(&[position, position, T::ZERO, T::ZERO]);
        let filter = PublishedAdaptiveKalman::new(
            start,
            Covariance::from_variances(&q),
            Covariance::from_variances(&r),
            forgetting,
            forgetting,
        );
        match filter {
            Ok(filter) => Self { scenario, filter },
            Err(_) => support::fail("factors that make sense"),
        }
    }
}

impl<T: Named> Tracker for Published<T> {
    const NAME: &str = "aekf4-published";
    const SCALAR: &str = T::NAME;
    type Record = Ranges;
    type Input = [T; 4];

    fn input(record: &Ranges) -> [T; 4] {
        record.ranges.map(T::from_f32)
    }

    #[inline(always)]
    fn step(&mut self, ranges: &[T; 4]) -> Class {
        if self.filter.predict(&self.scenario.steady()).is_err() {
            return Class::Rejected;
        }
        let mean = self.filter.estimate().mean;
        let mut rows = SMatrix::<T, 4, 4>::zeros();
        let mut innovation = SVector::<T, 4>::zeros();
        for (index, (anchor, &range)) in self.scenario.anchors.iter().zip(ranges).enumerate() {
            let ExpectedRange { distance, direction: [x, y] } =
                self.scenario.expected(mean.as_array(), anchor);
            innovation.as_array_mut()[index] = range - distance;
            rows.as_columns_mut()[0][index] = x;
            rows.as_columns_mut()[1][index] = y;
        }
        if self.filter.update(&rows, &innovation).is_ok() { Class::Update } else { Class::Rejected }
    }

    fn position(&self) -> [f32; 3] {
        place(self.filter.estimate())
    }
}
