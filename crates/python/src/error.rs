//! The package's only exception.

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

/// An exception with a crate's sentence.
pub(crate) fn refused(error: impl Display) -> PyErr {
    KestirimError::new_err(error.to_string())
}

/// An exception with a crate's sentence about one of the samples, which are counted from 0 as in Python.
pub(crate) fn refused_at(index: usize, error: impl Display) -> PyErr {
    KestirimError::new_err(format!("sample {index}: {error}"))
}

/// An exception for a word that is not among the known ones.
pub(crate) fn unknown(what: &str, found: &str, expected: &str) -> PyErr {
    KestirimError::new_err(format!("{what}: expected {expected}, found {found:?}"))
}
