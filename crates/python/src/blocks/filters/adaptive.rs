//! The adaptive Kalman filter.

use kestirim_adaptive_kalman::AdaptiveKalman;
use kestirim_kalman::{Covariance, Linear, SparseRow};
use nalgebra::SMatrix;
use pyo3::prelude::*;

use super::{Answer, AnyFilter, MOST, Row, expected};
use crate::blocks::sleep::{loaded, stored};
use crate::error::refused;

/// A filter that estimates Q and R.
pub(super) struct Adaptive<const N: usize> {
    pub(super) f: SMatrix<f64, N, N>,
    pub(super) filter: AdaptiveKalman<f64, N, MOST>,
}

impl<const N: usize> AnyFilter for Adaptive<N> {
    fn predict(&mut self) -> PyResult<()> {
        // The filter adds the noise that it has estimated.
        let none = Covariance::zero();
        self.filter.predict(&Linear { f: &self.f, q: &none }).map_err(refused)
    }

    fn correct(&mut self, rows: &[Row], innovation: &[f64]) -> Answer {
        let before = self.filter.estimate().mean;
        let mut nis = 0.0;
        for (index, (row, innovation)) in rows.iter().zip(innovation).enumerate() {
            if innovation.is_nan() {
                continue;
            }
            let moved = self.filter.estimate().mean - before;
            let left = innovation - expected(row, moved.as_slice());
            let mut entries = [(0, 0.0); N];
            for (index, number) in row {
                entries[*index] = (*index, *number);
            }
            for (index, entry) in entries.iter_mut().enumerate() {
                entry.0 = index;
            }
            nis += self.filter.update(index, &SparseRow::new(entries), left).map_err(refused)?.nis;
        }
        Ok(nis)
    }

    fn mean(&self) -> &[f64] {
        self.filter.estimate().mean.as_slice()
    }

    fn add_covariance(&self, rows: &mut Vec<f64>) {
        // It is symmetric: its columns are its rows.
        rows.extend_from_slice(self.filter.estimate().covariance.to_matrix().as_slice());
    }

    fn tell(&self, measurements: usize, r: &mut Vec<f64>, q: &mut Vec<f64>) {
        let noise = self.filter.measurement_noise();
        r.extend(
            noise
                .iter()
                .take(measurements)
                .map(kestirim_adaptive_kalman::MeasurementNoise::variance),
        );
        q.extend(self.filter.process_noise().variances());
    }

    fn copy(&self) -> Box<dyn AnyFilter> {
        let Self { f, filter } = *self;
        Box::new(Self { f, filter })
    }

    fn kind(&self) -> &'static str {
        "adaptive"
    }

    fn snapshot(&self, made_for: &str) -> PyResult<Vec<u8>> {
        stored(self.filter, made_for)
    }

    fn restore(&mut self, bytes: &[u8], made_for: &str) -> PyResult<()> {
        self.filter = loaded(bytes, made_for)?;
        Ok(())
    }
}
