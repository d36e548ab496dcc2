//! Kalman filters with a linear model: plain, adaptive, robust.

mod adaptive;
mod plain;
mod robust;

use kestirim_adaptive_kalman::{AdaptiveKalman, Learning, ProcessNoise};
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::Robust;
use nalgebra::SMatrix;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use self::adaptive::Adaptive;
use self::plain::Plain;
use self::robust::Outliers;
use super::{matrix, of_size};
use crate::arrays::{Line, Results, Table, values};
use crate::error::{KestirimError, refused, refused_at, unknown};

/// The largest number of measurements at a time.
const MOST: usize = 12;

/// The transition and the process noise of a model.
struct Model<const N: usize> {
    f: SMatrix<f64, N, N>,
    q: Covariance<f64, N>,
}

/// A row of H, as its nonzero entries.
type Row = Vec<(usize, f64)>;

fn row_of(numbers: &[f64]) -> Row {
    numbers.iter().copied().enumerate().filter(|(_, number)| *number != 0.0).collect()
}

fn expected(row: &Row, mean: &[f64]) -> f64 {
    row.iter().map(|(index, number)| number * mean[*index]).sum()
}

/// The recorded results of the steps.
#[derive(Default)]
struct Record {
    x: Vec<f64>,
    p: Vec<f64>,
    innovation: Vec<f64>,
    nis: Vec<f64>,
    /// Results of one kind of filter: R and Q of the adaptive one, or weights of the robust one.
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

/// The result of an update: the NIS of its measurements.
type Answer = Result<f64, PyErr>;

/// A filter of any number of states.
trait AnyFilter: Send + Sync {
    fn predict(&mut self) -> PyResult<()>;
    /// Updates with innovations z − H x⁻ (NaN where nothing was measured) and their rows.
    fn correct(&mut self, rows: &[Row], innovation: &[f64]) -> Answer;
    fn mean(&self) -> &[f64];
    /// Appends the rows of P.
    fn add_covariance(&self, rows: &mut Vec<f64>);
    /// Appends the results that are specific to this kind of filter.
    fn tell(&self, measurements: usize, first: &mut Vec<f64>, second: &mut Vec<f64>);
    fn copy(&self) -> Box<dyn AnyFilter>;
    fn kind(&self) -> &'static str;
    fn snapshot(&self, made_for: &str) -> PyResult<Vec<u8>>;
    fn restore(&mut self, bytes: &[u8], made_for: &str) -> PyResult<()>;

    /// Predicts and updates with each row of measurements; on failure, the index of the refused sample and the error.
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

/// The parameters of the different kinds of filters.
struct Kind<'a> {
    name: &'a str,
    /// Parameters of the adaptive filter: α; the least and largest values of R and of Q.
    forgetting: f64,
    limits: [f64; 4],
    /// The method of the robust filter.
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
        Ok(PyBytes::new(py, &self.filter.snapshot(&self.made_for())?))
    }

    fn restore(&mut self, snapshot: &[u8]) -> PyResult<()> {
        self.filter.restore(snapshot, &self.made_for())
    }

    /// Updates with measurements z (m,); returns their NIS.
    fn update(&mut self, z: Line<'_>) -> PyResult<f64> {
        let innovation = self.innovation(values(&z)?);
        let mut next = self.filter.copy();
        let nis = next.correct(&self.rows, &innovation)?;
        self.filter = next;
        Ok(nis)
    }

    /// Updates with innovations (m,) and rows (m, n) of a model that was linearised elsewhere; returns the NIS.
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

    /// Predicts and updates with each row of zs (n, m): all rows, or none.
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
    /// The description that a snapshot contains in addition to the number of states.
    fn made_for(&self) -> String {
        format!("a {} filter, measurements: {}", self.filter.kind(), self.rows.len())
    }

    fn innovation(&self, z: &[f64]) -> Vec<f64> {
        let mean = self.filter.mean();
        self.rows.iter().zip(z).map(|(row, z)| z - expected(row, mean)).collect()
    }
}
