//! The robust Kalman filter.

use kestirim_kalman::Gaussian;
use kestirim_robust_kalman::{Decision, Measurement, Robust};
use pyo3::prelude::*;

use super::{Answer, AnyFilter, MOST, Model, Row};
use crate::blocks::sleep::{loaded, stored};
use crate::error::refused;

/// A filter that weights measurements by their residuals.
pub(super) struct Outliers<const N: usize> {
    pub(super) model: Model<N>,
    pub(super) estimate: Gaussian<f64, N>,
    pub(super) robust: Robust<f64>,
    pub(super) variances: Vec<f64>,
    pub(super) weights: Vec<f64>,
}

impl<const N: usize> AnyFilter for Outliers<N> {
    fn predict(&mut self) -> PyResult<()> {
        self.estimate.predict(&self.model.f, &self.model.q).map_err(refused)
    }

    fn correct(&mut self, rows: &[Row], innovation: &[f64]) -> Answer {
        let all = rows.iter().zip(innovation).zip(&self.variances);
        let measured = all.filter(|((_, innovation), _)| !innovation.is_nan());
        let measurements: Vec<_> = measured
            .map(|((row, innovation), variance)| Measurement {
                row,
                innovation: *innovation,
                variance: *variance,
            })
            .collect();
        let mut decisions = [Decision::NONE; MOST];
        let summary = self.robust.update(&mut self.estimate, &measurements, &mut decisions);
        let summary = summary.map_err(refused)?;
        let mut told = decisions.iter();
        self.weights =
            innovation
                .iter()
                .map(|it| {
                    if it.is_nan() {
                        f64::NAN
                    } else {
                        told.next().map_or(f64::NAN, |it| it.weight)
                    }
                })
                .collect();
        Ok(summary.nis)
    }

    fn mean(&self) -> &[f64] {
        self.estimate.mean.as_slice()
    }

    fn add_covariance(&self, rows: &mut Vec<f64>) {
        // It is symmetric: its columns are its rows.
        rows.extend_from_slice(self.estimate.covariance.to_matrix().as_slice());
    }

    fn tell(&self, measurements: usize, weights: &mut Vec<f64>, _: &mut Vec<f64>) {
        let of = |index| self.weights.get(index).copied().unwrap_or(f64::NAN);
        weights.extend((0..measurements).map(of));
    }

    fn copy(&self) -> Box<dyn AnyFilter> {
        let Self { model: Model { f, q }, estimate, robust, .. } = *self;
        let (variances, weights) = (self.variances.clone(), self.weights.clone());
        Box::new(Self { model: Model { f, q }, estimate, robust, variances, weights })
    }

    fn kind(&self) -> &'static str {
        "robust"
    }

    fn snapshot(&self, made_for: &str) -> PyResult<Vec<u8>> {
        stored(self.estimate, made_for)
    }

    fn restore(&mut self, bytes: &[u8], made_for: &str) -> PyResult<()> {
        self.estimate = loaded(bytes, made_for)?;
        Ok(())
    }
}
