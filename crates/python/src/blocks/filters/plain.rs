//! The Kalman filter.

use kestirim_kalman::{Covariance, Gaussian};
use nalgebra::{SMatrix, SVector};
use pyo3::prelude::*;

use super::{Answer, AnyFilter, Model, Row, expected};
use crate::blocks::matrix;
use crate::blocks::sleep::{loaded, stored};
use crate::error::refused;

/// A filter that processes each measurement separately, or all at once if their noises are correlated.
pub(super) struct Plain<const N: usize> {
    pub(super) model: Model<N>,
    pub(super) estimate: Gaussian<f64, N>,
    pub(super) r: Vec<f64>,
    pub(super) is_diagonal: bool,
}

impl<const N: usize> Plain<N> {
    fn at_once<const M: usize>(&mut self, rows: &[Row], innovation: &[f64]) -> Answer {
        let mut h = SMatrix::<f64, M, N>::zeros();
        for (line, row) in rows.iter().enumerate() {
            for (column, number) in row {
                h[(line, *column)] = *number;
            }
        }
        let r = Covariance::from_lower_triangle(&matrix::<M, M>(&self.r)?);
        let innovation = SVector::<f64, M>::from_column_slice(innovation);
        let report = self.estimate.update_block(&h, &innovation, &r).map_err(refused)?;
        Ok(report.nis)
    }
}

impl<const N: usize> AnyFilter for Plain<N> {
    fn predict(&mut self) -> PyResult<()> {
        self.estimate.predict(&self.model.f, &self.model.q).map_err(refused)
    }

    fn correct(&mut self, rows: &[Row], innovation: &[f64]) -> Answer {
        let count = rows.len();
        if self.is_diagonal {
            let before = self.estimate;
            let mut nis = 0.0;
            for (index, (row, innovation)) in rows.iter().zip(innovation).enumerate() {
                if innovation.is_nan() {
                    continue;
                }
                // The innovations refer to the prediction.
                let moved = self.estimate.mean - before.mean;
                let left = innovation - expected(row, moved.as_slice());
                let report = self.estimate.weigh_entries(row, left, self.r[index * (count + 1)]);
                let report = report.and_then(|weighed| self.estimate.correct(&weighed));
                nis += report.map_err(refused)?.nis;
            }
            return Ok(nis);
        }
        if innovation.iter().any(|innovation| innovation.is_nan()) {
            let sentence = "measurements whose noises are correlated come together, or not at all";
            return if innovation.iter().all(|it| it.is_nan()) {
                Ok(0.0)
            } else {
                Err(refused(sentence))
            };
        }
        match count {
            1 => self.at_once::<1>(rows, innovation),
            2 => self.at_once::<2>(rows, innovation),
            3 => self.at_once::<3>(rows, innovation),
            4 => self.at_once::<4>(rows, innovation),
            5 => self.at_once::<5>(rows, innovation),
            6 => self.at_once::<6>(rows, innovation),
            _ => Err(refused("R: expected a diagonal one of more than six measurements")),
        }
    }

    fn mean(&self) -> &[f64] {
        self.estimate.mean.as_slice()
    }

    fn add_covariance(&self, rows: &mut Vec<f64>) {
        // It is symmetric: its columns are its rows.
        rows.extend_from_slice(self.estimate.covariance.to_matrix().as_slice());
    }

    fn tell(&self, _: usize, _: &mut Vec<f64>, _: &mut Vec<f64>) {}

    fn copy(&self) -> Box<dyn AnyFilter> {
        let Self { model: Model { f, q }, estimate, is_diagonal, .. } = *self;
        Box::new(Self { model: Model { f, q }, estimate, is_diagonal, r: self.r.clone() })
    }

    fn kind(&self) -> &'static str {
        "plain"
    }

    fn snapshot(&self, made_for: &str) -> PyResult<Vec<u8>> {
        stored(self.estimate, made_for)
    }

    fn restore(&mut self, bytes: &[u8], made_for: &str) -> PyResult<()> {
        self.estimate = loaded(bytes, made_for)?;
        Ok(())
    }
}
