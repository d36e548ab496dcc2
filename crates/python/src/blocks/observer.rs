//! Luenberger observers.

use kestirim_luenberger::{Plant, Predictor, PredictorGains};
use nalgebra::{SMatrix, SVector};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use super::sleep::{loaded, stored};
use super::{matrix, of_size, too_many};
use crate::arrays::{Results, Table, values};
use crate::error::{refused, refused_at};

/// The largest number of inputs and of outputs: additional columns and rows of zeros change nothing.
const MOST: usize = 4;

/// An observer of any number of states.
trait AnyObserver: Send + Sync {
    fn estimate(&self) -> &[f64];
    fn innovation(&self, measured: &[f64; MOST]) -> [f64; MOST];
    fn step(&mut self, input: &[f64; MOST], measured: &[f64; MOST]) -> Result<(), PyErr>;
    fn coast(&mut self, input: &[f64; MOST]) -> Result<(), PyErr>;
    fn copy(&self) -> Box<dyn AnyObserver>;
    fn snapshot(&self, made_for: &str) -> PyResult<Vec<u8>>;
    fn restore(&mut self, bytes: &[u8], made_for: &str) -> PyResult<()>;
}

impl<const N: usize> AnyObserver for Predictor<f64, N, MOST, MOST> {
    fn estimate(&self) -> &[f64] {
        Self::estimate(self).as_slice()
    }

    fn innovation(&self, measured: &[f64; MOST]) -> [f64; MOST] {
        Self::innovation(self, &SVector::from(*measured)).into()
    }

    fn step(&mut self, input: &[f64; MOST], measured: &[f64; MOST]) -> Result<(), PyErr> {
        Self::step(self, &SVector::from(*input), &SVector::from(*measured)).map_err(refused)
    }

    fn coast(&mut self, input: &[f64; MOST]) -> Result<(), PyErr> {
        Self::coast(self, &SVector::from(*input)).map_err(refused)
    }

    fn copy(&self) -> Box<dyn AnyObserver> {
        Box::new(*self)
    }

    fn snapshot(&self, made_for: &str) -> PyResult<Vec<u8>> {
        stored(*self, made_for)
    }

    fn restore(&mut self, bytes: &[u8], made_for: &str) -> PyResult<()> {
        *self = loaded(bytes, made_for)?;
        Ok(())
    }
}

fn build<const N: usize>(
    [a, b, c, l, start]: [&[f64]; 5],
    [inputs, outputs]: [usize; 2],
) -> PyResult<Box<dyn AnyObserver>> {
    let plant = Plant {
        a: matrix(a)?,
        b: SMatrix::from_fn(
            |row, column| {
                if column < inputs { b[row * inputs + column] } else { 0.0 }
            },
        ),
        c: SMatrix::from_fn(|row, column| if row < outputs { c[row * N + column] } else { 0.0 }),
    };
    let gain = SMatrix::from_fn(
        |row, column| {
            if column < outputs { l[row * outputs + column] } else { 0.0 }
        },
    );
    let observer = Predictor::new(&PredictorGains::new(&plant, &gain), &matrix::<N, 1>(start)?);
    Ok(Box::new(observer.map_err(refused)?))
}

/// A Luenberger observer: x̂⁺ = A x̂ + B u + L (y − C x̂).
#[pyclass]
pub(crate) struct Observer {
    kind: Box<dyn AnyObserver>,
    inputs: usize,
    outputs: usize,
}

#[pymethods]
impl Observer {
    #[new]
    fn new(
        a: Table<'_>,
        b: Table<'_>,
        c: Table<'_>,
        l: Table<'_>,
        start: Vec<f64>,
    ) -> PyResult<Self> {
        let states = start.len();
        let all = [values(&a)?, values(&b)?, values(&c)?, values(&l)?, &start];
        let [inputs, outputs] = [all[1].len() / states.max(1), all[2].len() / states.max(1)];
        if inputs > MOST {
            return Err(too_many("inputs", inputs, &[0, MOST]));
        }
        if outputs > MOST || outputs == 0 {
            return Err(too_many("outputs", outputs, &[1, MOST]));
        }
        let sizes = [inputs, outputs];
        let kind = of_size!("states", states, [1 2 3 4 5 6 7 8], build(all, sizes))?;
        Ok(Self { kind, inputs, outputs })
    }

    fn x(&self) -> Vec<f64> {
        self.kind.estimate().to_vec()
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.kind.snapshot(&self.made_for())?))
    }

    fn restore(&mut self, snapshot: &[u8]) -> PyResult<()> {
        self.kind.restore(snapshot, &self.made_for())
    }

    /// Processes inputs us (n, m) and measurements ys (n, p), NaN where nothing was measured: all rows, or none.
    fn run<'py>(
        &mut self,
        py: Python<'py>,
        us: Table<'py>,
        ys: Table<'py>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (us, ys) = (values(&us)?, values(&ys)?);
        let (inputs, outputs, mut next) = (self.inputs, self.outputs, self.kind.copy());
        let states = next.estimate().len();
        let count = ys.len() / outputs;
        let (x, innovations) = py.detach(|| -> PyResult<_> {
            let (mut x, mut innovations) = (Vec::new(), Vec::new());
            for (index, y) in ys.chunks_exact(outputs).enumerate() {
                let u = &us[index * inputs..(index + 1) * inputs];
                let padded = |numbers: &[f64]| {
                    std::array::from_fn(|place| numbers.get(place).copied().unwrap_or_default())
                };
                let (u, measured): ([f64; MOST], [f64; MOST]) = (padded(u), padded(y));
                x.extend(next.estimate());
                innovations.extend(next.innovation(&measured).into_iter().take(outputs));
                let at = |error: PyErr| Python::attach(|py| refused_at(index, error.value(py)));
                if y.iter().all(|y| y.is_nan()) {
                    next.coast(&u).map_err(at)?;
                } else {
                    next.step(&u, &measured).map_err(at)?;
                }
            }
            Ok((x, innovations))
        })?;
        self.kind = next;
        Ok(Results::new(py)
            .shaped("x", x, [count, states])?
            .shaped("innovation", innovations, [count, outputs])?
            .done())
    }
}

impl Observer {
    /// The description that a snapshot contains in addition to the number of states.
    fn made_for(&self) -> String {
        format!("an observer, inputs: {}, outputs: {}", self.inputs, self.outputs)
    }
}
