//! The one exception.

use std::fmt::Display;

use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;

create_exception!(
    kestirim,
    KestirimError,
    PyValueError,
    "What was given cannot be used: the sentence says what was found, and what was expected."
);

/// With a crate's sentence.
pub(crate) fn refused(error: impl Display) -> PyErr {
    KestirimError::new_err(error.to_string())
}

/// With a crate's sentence about one of the samples, counted from 0 as Python does.
pub(crate) fn refused_at(index: usize, error: impl Display) -> PyErr {
    KestirimError::new_err(format!("sample {index}: {error}"))
}

/// None of the words that are understood.
pub(crate) fn unknown(what: &str, found: &str, expected: &str) -> PyErr {
    KestirimError::new_err(format!("{what}: expected {expected}, found {found:?}"))
}
