//! The common scenario with the robust filter that treats the worst range first.

use kestirim_kalman::Gaussian;
use kestirim_robust_kalman::{
    Decision, Descent, Igg3, Measurement, NoFactor, Robust as Weights, UnitScale,
};
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::ExpectedRange;
use support::Class;

use super::{Named, Scenario, place};
use crate::replay::Tracker;
use crate::stream::Ranges;

/// The robust filter.
pub struct Robust<T: Scalar> {
    scenario: Scenario<T>,
    weights: Weights<T, Igg3<T>, UnitScale, NoFactor>,
    estimate: Gaussian<T, 4>,
    decisions: [Decision<T>; 4],
}

impl<T: Scalar> Default for Robust<T> {
    fn default() -> Self {
        let scenario = Scenario::default();
        let estimate = scenario.estimate();
        let (k0, k1) = (T::from_f64(2.5), T::from_f64(6.0));
        let igg3 = Igg3 { k0, k1, descent: Descent::Squared };
        Self {
            scenario,
            weights: Weights::iterative_igg3().lean(igg3),
            estimate,
            decisions: [Decision::NONE; 4],
        }
    }
}

impl<T: Named> Tracker for Robust<T> {
    const NAME: &str = "robust4-ranges4";
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
        let mut rows = [[(0, T::ZERO); 2]; 4];
        let mut innovations = [T::ZERO; 4];
        let places = self.scenario.anchors.iter().zip(ranges);
        for ((anchor, &range), (row, innovation)) in
            places.zip(rows.iter_mut().zip(&mut innovations))
        {
            let ExpectedRange { distance, direction: [x, y] } =
                self.scenario.expected(self.estimate.mean.as_array(), anchor);
            (*row, *innovation) = ([(0, x), (1, y)], range - distance);
        }
        let [a, b, c, d] = &rows;
        let [p, q, r, s] = innovations;
        let epoch = [(a, p), (b, q), (c, r), (d, s)].map(|(row, innovation)| Measurement {
            row,
            innovation,
            variance: self.scenario.range_variance,
        });
        match self.weights.update(&mut self.estimate, &epoch, &mut self.decisions) {
            Ok(_) => Class::Update,
            Err(_) => Class::Rejected,
        }
    }

    fn position(&self) -> [f32; 3] {
        place(&self.estimate)
    }
}
