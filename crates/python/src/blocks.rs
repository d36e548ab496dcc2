//! The building blocks: estimators for any sensor, and the design of observers.

pub(crate) mod attitude;
pub(crate) mod design;
pub(crate) mod filters;
pub(crate) mod observer;
pub(crate) mod particles;
mod sleep;

use nalgebra::SMatrix;
use pyo3::PyResult;

use crate::error::KestirimError;

/// Calls a function that is generic over a number with a number that is only known at run time.
macro_rules! of_size {
    ($what:literal, $size:expr, [$($number:literal)*], $function:ident $arguments:tt) => {
        match $size {
            $($number => $function::<$number> $arguments,)*
            other => Err($crate::blocks::too_many($what, other, &[$($number),*])),
        }
    };
}
pub(crate) use of_size;

/// The error for a size that is not compiled in.
pub(crate) fn too_many(what: &str, found: usize, built: &[usize]) -> pyo3::PyErr {
    let (least, most) = (built.first().unwrap_or(&0), built.last().unwrap_or(&0));
    KestirimError::new_err(format!("expected {least} to {most} {what}, found {found}"))
}

/// A matrix from the numbers of its rows.
pub(crate) fn matrix<const R: usize, const C: usize>(rows: &[f64]) -> PyResult<SMatrix<f64, R, C>> {
    if rows.len() != R * C {
        let found = rows.len();
        return Err(KestirimError::new_err(format!("expected {R} × {C} numbers, found {found}")));
    }
    Ok(SMatrix::from_row_slice(rows))
}

/// The numbers of a matrix, row by row.
pub(crate) fn numbers<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}
