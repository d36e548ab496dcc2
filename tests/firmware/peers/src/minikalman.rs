//! [`minikalman`]: row-major matrices in user-supplied buffers, in floating or fixed point; its extended filter takes
//! the state transition and the expected measurement as closures.

use fixed::types::I16F16;
use images::four_ranges::{Scenario, transition};
use images::replay::Tracker;
use images::stream::Ranges;
use kestirim_scalar::{Q16_16, Scalar};
use minikalman::buffers::types::*;
use minikalman::extended::{
    ExtendedKalman, ExtendedKalmanBuilder, ExtendedObservation, ExtendedObservationBuilder,
};
use minikalman::matrix::{
    AsMatrix, AsMatrixMut, MatrixDataArray, MatrixDataType, RowMajorSequentialData,
    RowMajorSequentialDataMut,
};
use minikalman::prelude::ObservationMatrixMut;
use support::Class;

/// A number type of `minikalman`, and ours of the same format, in which the expected ranges are computed.
pub trait Number: MatrixDataType + Default {
    /// Our type of the same format.
    type Ours: Scalar;
    /// The name for tables.
    const NAME: &str;

    /// Converts from our type, bit for bit.
    fn from_ours(ours: Self::Ours) -> Self;

    /// Converts to our type, bit for bit.
    fn to_ours(self) -> Self::Ours;
}

impl Number for f32 {
    type Ours = f32;
    const NAME: &str = "f32";

    #[inline(always)]
    fn from_ours(ours: f32) -> f32 {
        ours
    }

    #[inline(always)]
    fn to_ours(self) -> f32 {
        self
    }
}

impl Number for I16F16 {
    type Ours = Q16_16;
    const NAME: &str = "q16.16";

    #[inline(always)]
    fn from_ours(ours: Q16_16) -> I16F16 {
        ours.into()
    }

    #[inline(always)]
    fn to_ours(self) -> Q16_16 {
        self.into()
    }
}

type Square<T> = MatrixDataArray<4, 4, 16, T>;
type Column<T> = MatrixDataArray<4, 1, 4, T>;
type Line<T> = MatrixDataArray<1, 4, 4, T>;
type Single<T> = MatrixDataArray<1, 1, 1, T>;

type Filter<T> = ExtendedKalman<
    4,
    T,
    StateTransitionMatrixBuffer<4, T, Square<T>>,
    StateVectorBuffer<4, T, Column<T>>,
    EstimateCovarianceMatrixBuffer<4, T, Square<T>>,
    DirectProcessNoiseCovarianceMatrixBuffer<4, T, Square<T>>,
    PredictedStateEstimateVectorBuffer<4, T, Column<T>>,
    TemporaryStateMatrixBuffer<4, T, Square<T>>,
>;

type Observation<T> = ExtendedObservation<
    4,
    1,
    T,
    ObservationMatrixMutBuffer<1, 4, T, Line<T>>,
    MeasurementVectorBuffer<1, T, Single<T>>,
    MeasurementNoiseCovarianceMatrixBuffer<1, T, Single<T>>,
    InnovationVectorBuffer<1, T, Single<T>>,
    InnovationCovarianceMatrixBuffer<1, T, Single<T>>,
    KalmanGainMatrixBuffer<4, 1, T, Column<T>>,
    TemporaryResidualCovarianceInvertedMatrixBuffer<1, T, Single<T>>,
    TemporaryHPMatrixBuffer<1, 4, T, Line<T>>,
    TemporaryPHTMatrixBuffer<4, 1, T, Column<T>>,
    TemporaryKHPMatrixBuffer<4, T, Square<T>>,
>;

/// The common scenario with `minikalman`.
pub struct Minikalman<T: Number> {
    scenario: Scenario<T::Ours>,
    interval: T,
    filter: Filter<T>,
    range: Observation<T>,
}

impl<T: Number> Default for Minikalman<T> {
    fn default() -> Self {
        let scenario = Scenario::default();
        let zero = T::default();
        let [f, q] = transition(&scenario).map(|rows| {
            let mut flat = [zero; 16];
            for (flat, entry) in flat.iter_mut().zip(rows.as_flattened()) {
                *flat = T::from_ours(*entry);
            }
            flat
        });
        let mut covariance = [zero; 16];
        for variance in covariance.iter_mut().step_by(5) {
            *variance = T::from_ours(scenario.start_variance);
        }
        let filter = ExtendedKalmanBuilder::new::<4, T>(
            f.into(),
            scenario.start.map(T::from_ours).into(),
            covariance.into(),
            q.into(),
            [zero; 4].into(),
            [zero; 16].into(),
        );
        let range = ExtendedObservationBuilder::new::<4, 1, T>(
            [zero; 4].into(),
            [zero].into(),
            [T::from_ours(scenario.range_variance)].into(),
            [zero].into(),
            [zero].into(),
            [zero; 4].into(),
            [zero].into(),
            [zero; 4].into(),
            [zero; 4].into(),
            [zero; 16].into(),
        );
        let interval = T::from_ours(scenario.interval);
        Self { scenario, interval, filter, range }
    }
}

/// The four states.
#[inline(always)]
fn state<T: Number>(filter: &Filter<T>) -> [T; 4] {
    let states = filter.state_vector().as_matrix().as_slice();
    states.first_chunk().copied().unwrap_or_default()
}

impl<T: Number> Tracker for Minikalman<T> {
    const NAME: &str = "peer-minikalman";
    const SCALAR: &str = T::NAME;
    type Record = Ranges;
    type Input = [T; 4];

    fn input(record: &Ranges) -> [T; 4] {
        record.ranges.map(|range| T::from_ours(Scalar::from_f32(range)))
    }

    #[inline(always)]
    fn step(&mut self, ranges: &[T; 4]) -> Class {
        let interval = self.interval;
        self.filter.predict_nonlinear(|current, next| {
            let current = current.as_matrix().as_slice();
            let next = next.as_matrix_mut().as_mut_slice();
            if let ([px, py, vx, vy], [nx, ny, nvx, nvy]) = (current, next) {
                (*nx, *ny) = (*px + interval * *vx, *py + interval * *vy);
                (*nvx, *nvy) = (*vx, *vy);
            }
        });
        for (anchor, &range) in self.scenario.anchors.iter().zip(ranges) {
            let expected = self.scenario.expected(&state(&self.filter).map(T::to_ours), anchor);
            let row = self.range.observation_jacobian_matrix_mut().as_matrix_mut();
            if let [hx, hy, ..] = row.as_mut_slice() {
                [*hx, *hy] = expected.direction.map(T::from_ours);
            }
            let measured = self.range.measurement_vector_mut().as_matrix_mut();
            if let [measured] = measured.as_mut_slice() {
                *measured = range;
            }
            self.filter.correct_nonlinear(&mut self.range, |_, observation| {
                if let [observation] = observation.as_matrix_mut().as_mut_slice() {
                    *observation = T::from_ours(expected.distance);
                }
            });
        }
        Class::Update
    }

    fn position(&self) -> [f32; 3] {
        let [x, y, ..] = state(&self.filter).map(|value| value.to_ours().to_f32());
        [x, y, 0.0]
    }
}
