//! Conversion of arrays to and from Python.

use kestirim_health::{Health, State};
use kestirim_replay::{Finding, ScalarKind};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;
use numpy::{Element, IntoPyArray, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::error::{KestirimError, unknown};

/// An array of shape (n,).
pub(crate) type Line<'py> = PyReadonlyArray1<'py, f64>;
/// An array of integers of shape (n,).
pub(crate) type Counts<'py> = PyReadonlyArray1<'py, i64>;
/// An array of shape (n, k).
pub(crate) type Table<'py> = PyReadonlyArray2<'py, f64>;

/// The numbers of an array, row by row; the package has made it contiguous and of this shape.
pub(crate) fn values<'a, T: Element, D: numpy::ndarray::Dimension>(
    array: &'a numpy::PyReadonlyArray<'_, T, D>,
) -> PyResult<&'a [T]> {
    array.as_slice().map_err(|_| KestirimError::new_err("expected a contiguous array"))
}

/// The rows of an array, whose length is known at compile time.
pub(crate) fn rows<'a, const K: usize>(array: &'a Table<'_>) -> PyResult<&'a [[f64; K]]> {
    match values(array)?.as_chunks() {
        (rows, []) => Ok(rows),
        _ => Err(KestirimError::new_err(format!("expected rows of {K} numbers"))),
    }
}

/// Results by name, in the order in which they are added.
pub(crate) struct Results<'py>(Bound<'py, PyDict>);

impl<'py> Results<'py> {
    pub(crate) fn new(py: Python<'py>) -> Self {
        Self(PyDict::new(py))
    }

    pub(crate) fn with(self, name: &str, value: impl IntoPyObject<'py>) -> PyResult<Self> {
        self.0.set_item(name, value)?;
        Ok(self)
    }

    /// Adds an array of shape (n,), without a copy.
    pub(crate) fn line<T: Element>(self, name: &str, values: Vec<T>) -> PyResult<Self> {
        let array = values.into_pyarray(self.0.py());
        self.with(name, array)
    }

    /// Adds an array of shape (n, K), without a copy.
    pub(crate) fn table<const K: usize>(self, name: &str, rows: Vec<[f64; K]>) -> PyResult<Self> {
        let count = rows.len();
        let array = rows.into_flattened().into_pyarray(self.0.py()).reshape([count, K])?;
        self.with(name, array)
    }

    /// Adds an array of any shape, without a copy.
    pub(crate) fn shaped<const D: usize>(
        self,
        name: &str,
        values: Vec<f64>,
        shape: [usize; D],
    ) -> PyResult<Self>
    where
        numpy::ndarray::Dim<[usize; D]>: numpy::ndarray::Dimension,
        [usize; D]: numpy::ndarray::IntoDimension<Dim = numpy::ndarray::Dim<[usize; D]>>,
    {
        let array = values.into_pyarray(self.0.py()).reshape(shape)?;
        self.with(name, array)
    }

    /// Adds a tuple of words.
    pub(crate) fn words(
        self,
        name: &str,
        words: impl IntoIterator<Item = impl Into<String>>,
    ) -> PyResult<Self> {
        let words: Vec<String> = words.into_iter().map(Into::into).collect();
        let words = PyTuple::new(self.0.py(), words)?;
        self.with(name, words)
    }

    pub(crate) fn done(self) -> Bound<'py, PyDict> {
        self.0
    }
}

/// The number type with this name.
pub(crate) fn scalar(name: &str) -> PyResult<ScalarKind> {
    let known = ScalarKind::ALL.into_iter().find(|kind| kind.name() == name);
    known.ok_or_else(|| unknown("scalar", name, "'f32', 'f64' or 'fixed'"))
}

pub(crate) fn doubles<T: Scalar, const K: usize>(vector: &SVector<T, K>) -> [f64; K] {
    vector.as_array().map(T::to_f64)
}

/// Converts seconds to microseconds, as the readers of logs do.
pub(crate) fn microseconds(seconds: f64) -> i64 {
    (seconds * 1e6).round() as i64
}

/// The code of a state: 0 good, 1 degraded, 2 bad.
pub(crate) const fn code(state: State) -> u8 {
    match state {
        State::Good => 0,
        State::Degraded => 1,
        State::Bad => 2,
    }
}

/// Sentences about findings that impair every estimate of a log.
pub(crate) fn sentences(findings: &[Finding]) -> Vec<String> {
    findings.iter().filter(|finding| finding.is_fault()).map(Finding::sentence).collect()
}

/// The words for the reasons against an estimate.
pub(crate) fn reasons(health: Health) -> Vec<&'static str> {
    health.reasons().map(kestirim_health::Reason::words).collect()
}
