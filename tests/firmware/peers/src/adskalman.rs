//! [`adskalman`]: a linear filter with trait objects of nalgebra matrices; a measurement model may predict its
//! observation itself, which makes the filter an extended one.

use adskalman::{
    CovarianceUpdateMethod, ObservationModel, StateAndCovariance, TransitionModelLinearNoControl,
};
use images::four_ranges::{Scenario, transition};
use images::replay::Tracker;
use images::stream::Ranges;
use nalgebra::{
    Matrix1, Matrix1x4, Matrix4, Matrix4x1, OMatrix, OVector, U1, U4, Vector1, Vector4,
};
use support::Class;

struct Motion {
    f: Matrix4<f32>,
    f_transposed: Matrix4<f32>,
    q: Matrix4<f32>,
}

impl TransitionModelLinearNoControl<f32, U4> for Motion {
    fn F(&self) -> &OMatrix<f32, U4, U4> {
        &self.f
    }

    fn FT(&self) -> &OMatrix<f32, U4, U4> {
        &self.f_transposed
    }

    fn Q(&self) -> &OMatrix<f32, U4, U4> {
        &self.q
    }
}

/// A range, linearised at the estimate.
struct Range {
    h: Matrix1x4<f32>,
    h_transposed: Matrix4x1<f32>,
    expected: f32,
    r: Matrix1<f32>,
}

impl ObservationModel<f32, U4, U1> for Range {
    fn predict_observation(&self, _: &OVector<f32, U4>) -> OVector<f32, U1> {
        Vector1::new(self.expected)
    }

    fn H(&self) -> &OMatrix<f32, U1, U4> {
        &self.h
    }

    fn HT(&self) -> &OMatrix<f32, U4, U1> {
        &self.h_transposed
    }

    fn R(&self) -> &OMatrix<f32, U1, U1> {
        &self.r
    }
}

/// The common scenario with `adskalman`.
pub struct Adskalman {
    scenario: Scenario<f32>,
    motion: Motion,
    estimate: StateAndCovariance<f32, U4>,
}

impl Default for Adskalman {
    fn default() -> Self {
        let scenario = Scenario::default();
        let [f, q] = transition(&scenario).map(|rows| Matrix4::from_row_slice(rows.as_flattened()));
        let estimate = StateAndCovariance::new(
            Vector4::from(scenario.start),
            Matrix4::from_diagonal_element(scenario.start_variance),
        );
        Self { scenario, motion: Motion { f, f_transposed: f.transpose(), q }, estimate }
    }
}

impl Tracker for Adskalman {
    const NAME: &str = "peer-adskalman";
    const SCALAR: &str = "f32";
    type Record = Ranges;
    type Input = [f32; 4];

    fn input(record: &Ranges) -> [f32; 4] {
        record.ranges
    }

    #[inline(always)]
    fn step(&mut self, ranges: &[f32; 4]) -> Class {
        self.estimate = self.motion.predict(&self.estimate);
        for (anchor, &range) in self.scenario.anchors.iter().zip(ranges) {
            let state = self.estimate.state().data.0[0];
            let expected = self.scenario.expected(&state, anchor);
            let [x, y] = expected.direction;
            let h = Matrix1x4::new(x, y, 0.0, 0.0);
            let model = Range {
                h,
                h_transposed: h.transpose(),
                expected: expected.distance,
                r: Matrix1::new(self.scenario.range_variance),
            };
            let method = CovarianceUpdateMethod::OptimalKalman;
            match model.update(&self.estimate, &Vector1::new(range), method) {
                Ok(estimate) => self.estimate = estimate,
                Err(_) => return Class::Rejected,
            }
        }
        Class::Update
    }

    fn position(&self) -> [f32; 3] {
        let [x, y, ..] = self.estimate.state().data.0[0];
        [x, y, 0.0]
    }
}
