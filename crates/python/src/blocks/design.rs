//! The design of observers.

use kestirim_observer_design as design;
use kestirim_observer_design::{Complex, Discrete};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{matrix, numbers, too_many};
use crate::arrays::{Results, Table, values};
use crate::error::{refused, unknown};

/// Calls a function that is generic over two numbers with numbers that are only known at run time.
macro_rules! of_sizes {
    ($what:literal, $sizes:expr, [$(($n:literal $($p:literal)*))*], $function:ident $arguments:tt) => {
        match $sizes {
            $($(($n, $p) => $function::<$n, $p> $arguments,)*)*
            (states @ 1..=6, other) => Err(too_many($what, other, &[1, states.min(4)])),
            (states, _) => Err(too_many("states", states, &[1, 6])),
        }
    };
}

fn sizes(square: &[f64], other: &[f64]) -> (usize, usize) {
    let states = (square.len() as f64).sqrt() as usize;
    (states, other.len() / states.max(1))
}

/// A gain, row by row, and the poles that it places.
type Placed = (Vec<f64>, Vec<(f64, f64)>);

/// The gain L that places the eigenvalues of A − L C, and the actual eigenvalues.
#[pyfunction]
pub(crate) fn place<'py>(
    py: Python<'py>,
    a: Table<'py>,
    c: Table<'py>,
    poles: Vec<(f64, f64)>,
) -> PyResult<Bound<'py, PyDict>> {
    fn placed<const N: usize, const P: usize>(
        a: &[f64],
        c: &[f64],
        poles: &[Complex<f64>],
    ) -> PyResult<Placed> {
        let wanted = <[Complex<f64>; N]>::try_from(poles)
            .map_err(|_| refused(format!("poles: expected {N}, found {}", poles.len())))?;
        let found = design::place(&matrix::<N, N>(a)?, &matrix::<P, N>(c)?, &wanted);
        let found = found.map_err(refused)?;
        Ok((numbers(&found.gain), found.poles.iter().map(|pole| (pole.re, pole.im)).collect()))
    }
    let (a, c) = (values(&a)?, values(&c)?);
    let poles: Vec<_> = poles.into_iter().map(|(re, im)| Complex { re, im }).collect();
    let (states, outputs) = sizes(a, c);
    let (gain, poles) = of_sizes!(
        "outputs",
        (states, outputs),
        [(1 1) (2 1 2) (3 1 2 3) (4 1 2 3 4) (5 1 2 3 4) (6 1 2 3 4)],
        placed(a, c, &poles)
    )?;
    Ok(Results::new(py).shaped("gain", gain, [states, outputs])?.with("poles", poles)?.done())
}

/// The steady-state Kalman filter: the covariances before and after an update, and both gains.
#[pyfunction]
pub(crate) fn dare<'py>(
    py: Python<'py>,
    a: Table<'py>,
    c: Table<'py>,
    q: Table<'py>,
    r: Table<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    fn solved<const N: usize, const P: usize>(
        a: &[f64],
        c: &[f64],
        q: &[f64],
        r: &[f64],
    ) -> PyResult<[Vec<f64>; 4]> {
        let found = design::riccati(
            &matrix::<N, N>(a)?,
            &matrix::<P, N>(c)?,
            &matrix::<N, N>(q)?,
            &matrix::<P, P>(r)?,
        );
        let found = found.map_err(refused)?;
        let (filter, predictor) = (numbers(&found.filter_gain), numbers(&found.predictor_gain));
        Ok([numbers(&found.prior), numbers(&found.posterior), filter, predictor])
    }
    let (a, c, q, r) = (values(&a)?, values(&c)?, values(&q)?, values(&r)?);
    let (states, outputs) = sizes(a, c);
    let [prior, posterior, filter_gain, predictor_gain] = of_sizes!(
        "outputs",
        (states, outputs),
        [(1 1) (2 1 2) (3 1 2 3) (4 1 2 3 4) (5 1 2 3 4) (6 1 2 3 4)],
        solved(a, c, q, r)
    )?;
    Ok(Results::new(py)
        .shaped("prior", prior, [states, states])?
        .shaped("posterior", posterior, [states, states])?
        .shaped("filter_gain", filter_gain, [states, outputs])?
        .shaped("predictor_gain", predictor_gain, [states, outputs])?
        .done())
}

/// Discretises A and B.
#[pyfunction]
pub(crate) fn c2d<'py>(
    py: Python<'py>,
    a: Table<'py>,
    b: Table<'py>,
    interval: f64,
    method: &str,
) -> PyResult<Bound<'py, PyDict>> {
    fn stepped<const N: usize, const M: usize>(
        a: &[f64],
        b: &[f64],
        interval: f64,
        method: &str,
    ) -> PyResult<[Vec<f64>; 2]> {
        let (a, b) = (matrix::<N, N>(a)?, matrix::<N, M>(b)?);
        let found = match method {
            "zoh" => design::zero_order_hold(&a, &b, interval),
            "tustin" => design::tustin(&a, &b, interval),
            _ => return Err(unknown("method", method, "'zoh' or 'tustin'")),
        };
        let Discrete { a, b } = found.map_err(refused)?;
        Ok([numbers(&a), numbers(&b)])
    }
    let (a, b) = (values(&a)?, values(&b)?);
    let (states, inputs) = sizes(a, b);
    let [a, b] = of_sizes!(
        "inputs",
        (states, inputs),
        [(1 1 2 3 4) (2 1 2 3 4) (3 1 2 3 4) (4 1 2 3 4) (5 1 2 3 4) (6 1 2 3 4)],
        stepped(a, b, interval, method)
    )?;
    Ok(Results::new(py).shaped("a", a, [states, states])?.shaped("b", b, [states, inputs])?.done())
}
