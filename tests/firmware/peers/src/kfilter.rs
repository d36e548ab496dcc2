//! [`kfilter`]: nalgebra matrices; an extended filter with a user-defined measurement.

use images::four_ranges::{Scenario, transition};
use images::replay::Tracker;
use images::stream::Ranges;
use kfilter::measurement::{LinearisableMeasurement, Measurement};
use kfilter::system::LinearNoInputSystem;
use kfilter::{KalmanFilter, KalmanLinearNoInput, KalmanPredict, KalmanUpdate};
use nalgebra_034::{Matrix1, Matrix1x4, Matrix4, Matrix4x1, Vector1, Vector4};
use support::Class;

/// A range, linearised at the estimate.
struct Range {
    h: Matrix1x4<f32>,
    h_transposed: Matrix4x1<f32>,
    expected: f32,
    measured: Vector1<f32>,
    r: Matrix1<f32>,
}

impl Measurement<f32, 4, 1> for Range {
    fn covariance(&self) -> &Matrix1<f32> {
        &self.r
    }

    fn measurement(&self) -> &Vector1<f32> {
        &self.measured
    }

    fn set_measurement(&mut self, z: Vector1<f32>) {
        self.measured = z;
    }

    fn predict(&self, _: &Vector4<f32>) -> Vector1<f32> {
        Vector1::new(self.expected)
    }
}

impl LinearisableMeasurement<f32, 4, 1> for Range {
    fn observation(&self) -> &Matrix1x4<f32> {
        &self.h
    }

    fn observation_transpose(&self) -> &Matrix4x1<f32> {
        &self.h_transposed
    }
}

/// The common scenario with `kfilter`.
pub struct Kfilter {
    scenario: Scenario<f32>,
    filter: KalmanLinearNoInput<f32, 4>,
}

impl Default for Kfilter {
    fn default() -> Self {
        let scenario = Scenario::default();
        let [f, q] = transition(&scenario).map(|rows| Matrix4::from_row_slice(rows.as_flattened()));
        let system = LinearNoInputSystem::new(f, q, Vector4::from(scenario.start));
        let variance = Matrix4::from_diagonal_element(scenario.start_variance);
        Self { scenario, filter: KalmanLinearNoInput::new_custom(system, variance) }
    }
}

impl Tracker for Kfilter {
    const NAME: &str = "peer-kfilter";
    const SCALAR: &str = "f32";
    type Record = Ranges;
    type Input = [f32; 4];

    fn input(record: &Ranges) -> [f32; 4] {
        record.ranges
    }

    #[inline(always)]
    fn step(&mut self, ranges: &[f32; 4]) -> Class {
        if self.filter.predict().is_err() {
            return Class::Rejected;
        }
        for (anchor, &range) in self.scenario.anchors.iter().zip(ranges) {
            let state = self.filter.state().data.0[0];
            let expected = self.scenario.expected(&state, anchor);
            let [x, y] = expected.direction;
            let h = Matrix1x4::new(x, y, 0.0, 0.0);
            let measurement = Range {
                h,
                h_transposed: h.transpose(),
                expected: expected.distance,
                measured: Vector1::new(range),
                r: Matrix1::new(self.scenario.range_variance),
            };
            if self.filter.update(&measurement).is_err() {
                return Class::Rejected;
            }
        }
        Class::Update
    }

    fn position(&self) -> [f32; 3] {
        let [x, y, ..] = self.filter.state().data.0[0];
        [x, y, 0.0]
    }
}
