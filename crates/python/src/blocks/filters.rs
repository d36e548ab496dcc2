//! Kalman filters of a linear model: plain, adaptive, robust.

use kestirim_adaptive_kalman::{AdaptiveKalman, Learning, ProcessNoise};
use kestirim_kalman::{Covariance, Gaussian, Linear, SparseRow};
use kestirim_robust_kalman::{Decision, Measurement, Robust};
use nalgebra::{SMatrix, SVector};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use super::sleep::{loaded, stored};
use super::{matrix, of_size};
use crate::arrays::{Line, Results, Table, values};
use crate::error::{KestirimError, refused, refused_at, unknown};

/// Most measurements at a time.
const MOST: usize = 12;

/// What there is to know of a model.
struct Model<const N: usize> {
    f: SMatrix<f64, N, N>,
    q: Covariance<f64, N>,
}

/// A row of H: those of its entries that are not zero.
type Row = Vec<(usize, f64)>;

fn row_of(numbers: &[f64]) -> Row {
    numbers.iter().copied().enumerate().filter(|(_, number)| *number != 0.0).collect()
}

fn expected(row: &Row, mean: &[f64]) -> f64 {
    row.iter().map(|(index, number)| number * mean[*index]).sum()
}

/// What is written down of a step.
#[derive(Default)]
struct Record {
    x: Vec<f64>,
    p: Vec<f64>,
    innovation: Vec<f64>,
    nis: Vec<f64>,
    /// Of the adaptive filter: R and Q; of the robust one: weights.
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Record {
    fn with_room_for(count: usize, states: usize, measurements: usize) -> Self {
        Self {
            x: Vec::with_capacity(count * states),
            p: Vec::with_capacity(count * states * states),
            innovation: Vec::with_capacity(count * measurements),
            nis: Vec::with_capacity(count),
            ..Self::default()
        }
    }
}

/// What became of the measurements of a time: their NIS.
type Answer = Result<f64, PyErr>;

/// What a snapshot says beside the number of states.
fn made_for(kind: &str, measurements: usize) -> String {
    format!("a {kind} filter, measurements: {measurements}")
}

/// A filter of any number of states.
trait AnyFilter: Send + Sync {
    fn predict(&mut self) -> PyResult<()>;
    /// Takes innovations z − H x⁻ (not a number where nothing was measured) with their rows.
    fn correct(&mut self, rows: &[Row], innovation: &[f64]) -> Answer;
    fn mean(&self) -> &[f64];
    /// Adds the rows of P.
    fn add_covariance(&self, rows: &mut Vec<f64>);
    /// What is particular about the filter now.
    fn tell(&self, measurements: usize, first: &mut Vec<f64>, second: &mut Vec<f64>);
    fn copy(&self) -> Box<dyn AnyFilter>;
    fn snapshot(&self, measurements: usize) -> PyResult<Vec<u8>>;
    fn restore(&mut self, bytes: &[u8], measurements: usize) -> PyResult<()>;

    /// Predicts and updates with rows of measurements; the sample that was refused, and why.
    fn run(&mut self, rows: &[Row], zs: &[f64]) -> Result<Record, (usize, PyErr)> {
        let (states, measurements) = (self.mean().len(), rows.len());
        let mut record = Record::with_room_for(zs.len() / measurements, states, measurements);
        for (index, z) in zs.chunks_exact(measurements).enumerate() {
            self.predict().map_err(|error| (index, error))?;
            let begin = record.innovation.len();
            let mean = self.mean();
            record.innovation.extend(rows.iter().zip(z).map(|(row, z)| z - expected(row, mean)));
            let nis = self.correct(rows, &record.innovation[begin..]);
            record.nis.push(nis.map_err(|error| (index, error))?);
            record.x.extend_from_slice(self.mean());
            self.add_covariance(&mut record.p);
            self.tell(measurements, &mut record.first, &mut record.second);
        }
        Ok(record)
    }
}

/// Each measurement by itself, or all at once if their noises are correlated.
struct Plain<const N: usize> {
    model: Model<N>,
    estimate: Gaussian<f64, N>,
    r: Vec<f64>,
    is_diagonal: bool,
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
                // The innovations are those of the prediction.
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

    fn snapshot(&self, measurements: usize) -> PyResult<Vec<u8>> {
        stored(self.estimate, &made_for("plain", measurements))
    }

    fn restore(&mut self, bytes: &[u8], measurements: usize) -> PyResult<()> {
        self.estimate = loaded(bytes, &made_for("plain", measurements))?;
        Ok(())
    }
}

/// Learns Q and R.
struct Adaptive<const N: usize> {
    f: SMatrix<f64, N, N>,
    filter: AdaptiveKalman<f64, N, MOST>,
}

impl<const N: usize> AnyFilter for Adaptive<N> {
    fn predict(&mut self) -> PyResult<()> {
        // The filter brings the noise that it has learnt.
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

    fn snapshot(&self, measurements: usize) -> PyResult<Vec<u8>> {
        stored(self.filter, &made_for("adaptive", measurements))
    }

    fn restore(&mut self, bytes: &[u8], measurements: usize) -> PyResult<()> {
        self.filter = loaded(bytes, &made_for("adaptive", measurements))?;
        Ok(())
    }
}

/// Weighs measurements by their residuals.
struct Outliers<const N: usize> {
    model: Model<N>,
    estimate: Gaussian<f64, N>,
    robust: Robust<f64>,
    variances: Vec<f64>,
    weights: Vec<f64>,
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

    fn snapshot(&self, measurements: usize) -> PyResult<Vec<u8>> {
        stored(self.estimate, &made_for("robust", measurements))
    }

    fn restore(&mut self, bytes: &[u8], measurements: usize) -> PyResult<()> {
        self.estimate = loaded(bytes, &made_for("robust", measurements))?;
        Ok(())
    }
}

/// What belongs to each kind of filter.
struct Kind<'a> {
    name: &'a str,
    /// Of the adaptive filter: α; least and most of R and of Q.
    forgetting: f64,
    limits: [f64; 4],
    /// Of the robust one.
    method: &'a str,
}

fn build<const N: usize>(
    x: &[f64],
    p: &[f64],
    f: &[f64],
    q: &[f64],
    r: &[f64],
    kind: &Kind<'_>,
) -> PyResult<Box<dyn AnyFilter>> {
    let mean = matrix::<N, 1>(x)?;
    let estimate = Gaussian::new(mean, Covariance::from_lower_triangle(&matrix::<N, N>(p)?));
    let (f, q) = (matrix::<N, N>(f)?, matrix::<N, N>(q)?);
    let count = (r.len() as f64).sqrt() as usize;
    let diagonal: Vec<f64> = (0..count).map(|index| r[index * (count + 1)]).collect();
    let is_diagonal = (0..r.len()).all(|place| place % (count + 1) == 0 || r[place] == 0.0);
    if kind.name != "plain" && !is_diagonal {
        return Err(refused(
            "R: expected a diagonal matrix, since measurements are weighed one by one",
        ));
    }
    let noise = Covariance::from_lower_triangle(&q);
    let model = Model { f, q: noise };
    Ok(match kind.name {
        "plain" => Box::new(Plain { model, estimate, r: r.to_vec(), is_diagonal }),
        "adaptive" => {
            let [least_r, most_r, least_q, most_q] = kind.limits;
            let of_r = Learning::new(kind.forgetting, least_r, most_r).map_err(refused)?;
            let of_q = Learning::new(kind.forgetting, least_q, most_q).map_err(refused)?;
            let variances = std::array::from_fn(|state| q[(state, state)]);
            let process = ProcessNoise::new(variances, [of_q; N]);
            let variance = |index: usize| diagonal.get(index).copied().unwrap_or(1.0);
            let variances = std::array::from_fn(variance);
            let filter = AdaptiveKalman::new(estimate, process, variances, [of_r; MOST]);
            Box::new(Adaptive { f, filter })
        }
        _ => {
            let robust = match kind.method {
                "plain" => Robust::plain(),
                "igg3" => Robust::igg3(),
                "t-test" => Robust::t_test(),
                "iterative-igg3" => Robust::iterative_igg3(),
                other => {
                    let expected = "'iterative-igg3', 'igg3', 't-test' or 'plain'";
                    return Err(unknown("method", other, expected));
                }
            };
            let (variances, weights) = (diagonal, Vec::new());
            Box::new(Outliers { model, estimate, robust, variances, weights })
        }
    })
}

/// A Kalman filter of a linear model.
#[pyclass]
pub(crate) struct Filter {
    filter: Box<dyn AnyFilter>,
    rows: Vec<Row>,
}

#[pymethods]
impl Filter {
    #[new]
    fn new(
        x: Line<'_>,
        p: Table<'_>,
        f: Table<'_>,
        h: Table<'_>,
        q: Table<'_>,
        r: Table<'_>,
        kind: &str,
        forgetting: f64,
        limits: [f64; 4],
        method: &str,
    ) -> PyResult<Self> {
        let (x, h) = (values(&x)?, values(&h)?);
        let kind = Kind { name: kind, forgetting, limits, method };
        let (p, f, q, r) = (values(&p)?, values(&f)?, values(&q)?, values(&r)?);
        let filter =
            of_size!("states", x.len(), [1 2 3 4 5 6 7 8 9 10 11 12], build(x, p, f, q, r, &kind))?;
        let rows: Vec<Row> = h.chunks_exact(x.len()).map(row_of).collect();
        if rows.is_empty() || rows.len() > MOST {
            return Err(super::too_many("measurements", rows.len(), &[1, MOST]));
        }
        Ok(Self { filter, rows })
    }

    fn x(&self) -> Vec<f64> {
        self.filter.mean().to_vec()
    }

    fn p(&self) -> Vec<f64> {
        let mut rows = Vec::new();
        self.filter.add_covariance(&mut rows);
        rows
    }

    fn predict(&mut self) -> PyResult<()> {
        self.filter.predict()
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.filter.snapshot(self.rows.len())?))
    }

    fn restore(&mut self, snapshot: &[u8]) -> PyResult<()> {
        self.filter.restore(snapshot, self.rows.len())
    }

    /// z: (m,); answers with the NIS.
    fn update(&mut self, z: Line<'_>) -> PyResult<f64> {
        let innovation = self.innovation(values(&z)?);
        let mut next = self.filter.copy();
        let nis = next.correct(&self.rows, &innovation)?;
        self.filter = next;
        Ok(nis)
    }

    /// Innovations (m,) with rows (m, n) of a model that was linearised elsewhere; answers with the NIS.
    fn correct(&mut self, innovation: Line<'_>, h: Table<'_>) -> PyResult<f64> {
        let count = self.filter.mean().len();
        let rows: Vec<Row> = values(&h)?.chunks_exact(count).map(row_of).collect();
        if rows.len() != self.rows.len() {
            let (expected, found) = (self.rows.len(), rows.len());
            return Err(KestirimError::new_err(format!("expected {expected} rows, found {found}")));
        }
        let mut next = self.filter.copy();
        let nis = next.correct(&rows, values(&innovation)?)?;
        self.filter = next;
        Ok(nis)
    }

    /// zs: (n, m). Predicts and updates with each row; all of them, or none.
    fn filter<'py>(&mut self, py: Python<'py>, zs: Table<'py>) -> PyResult<Bound<'py, PyDict>> {
        let zs = values(&zs)?;
        let (mut next, rows) = (self.filter.copy(), &self.rows);
        let (states, measurements) = (next.mean().len(), rows.len());
        let count = zs.len() / measurements;
        let record = py.detach(|| next.run(rows, zs));
        let record = record.map_err(|(index, error)| refused_at(index, error.value(py)))?;
        self.filter = next;
        let extra = |numbers: &Vec<f64>| numbers.len().checked_div(count).unwrap_or(0);
        let (first, second) = (extra(&record.first), extra(&record.second));
        Ok(Results::new(py)
            .shaped("x", record.x, [count, states])?
            .shaped("P", record.p, [count, states, states])?
            .shaped("innovation", record.innovation, [count, measurements])?
            .line("nis", record.nis)?
            .shaped("first", record.first, [count, first])?
            .shaped("second", record.second, [count, second])?
            .done())
    }
}

impl Filter {
    fn innovation(&self, z: &[f64]) -> Vec<f64> {
        let mean = self.filter.mean();
        self.rows.iter().zip(z).map(|(row, z)| z - expected(row, mean)).collect()
    }
}
