//! The Kalman filter of a replay, sample by sample.

use std::collections::HashMap;

use kestirim_kalman::{Covariance, Gaussian, SparseRow};
use nalgebra::SVector;

use super::follow::Assumed;
use super::log::Sample;
use super::model::{Model, Step};
use super::scenario::Noise;
use crate::Error;

/// What is not known of a state that the first line does not measure: rad, rad/s, m/s, rad.
const UNKNOWN: [f64; 4] = [0.2, 0.5, 20.0, 0.5];
/// Of so many intervals.
const LONGEST_GAP: f64 = 1e6;
/// So many different intervals are remembered.
const MOST_STEPS: usize = 1000;

/// Transitions of the intervals that a log has.
#[derive(Debug, Clone)]
pub(super) struct Steps {
    model: Model,
    usual: f64,
    noise: [f64; 2],
    known: HashMap<i64, Step>,
}

impl Steps {
    /// Of a model whose inputs are noisy by these standard deviations a sample, `usual` seconds apart.
    pub(super) fn new(model: &Model, usual: f64, noise: [f64; 2]) -> Self {
        Self { model: model.clone(), usual, noise, known: HashMap::new() }
    }

    /// What happens in an interval.
    pub(super) fn over(&mut self, interval_us: i64) -> Result<Step, String> {
        if let Some(step) = self.known.get(&interval_us) {
            return Ok(*step);
        }
        let interval = interval_us as f64 / 1e6;
        if interval > LONGEST_GAP * self.usual {
            return Err(format!("no estimate outlives a gap of {interval} s"));
        }
        let step = self.model.over(interval, self.usual, self.noise)?;
        if self.known.len() == MOST_STEPS {
            self.known.clear();
        }
        self.known.insert(interval_us, step);
        Ok(step)
    }
}

/// A Kalman filter that starts at what the first sample measures.
#[derive(Debug, Clone)]
pub struct Filter {
    steps: Steps,
    /// Rows of C of what is measured, and variances.
    rows: Vec<(SparseRow<f64, 4>, f64)>,
    estimate: Gaussian<f64, 4>,
    /// Time and input of the sample before.
    before: Option<(i64, [f64; 2])>,
}

impl Filter {
    /// For a model of which these outputs are measured every `usual` seconds.
    pub fn new(model: &Model, outputs: &[usize], assumed: &Assumed, usual: f64) -> Self {
        let row = |(&output, sigma): (&usize, &f64)| {
            let row = model.outputs[output].1;
            (SparseRow::new(std::array::from_fn(|state| (state, row[state]))), sigma * sigma)
        };
        Self {
            steps: Steps::new(model, usual, assumed.inputs),
            rows: outputs.iter().zip(&assumed.outputs).map(row).collect(),
            estimate: Gaussian::new(
                SVector::zeros(),
                Covariance::from_variances(&UNKNOWN.map(|sigma| sigma * sigma)),
            ),
            before: None,
        }
    }

    /// Says how long an interval usually is, s: the inputs' noise is one a sample.
    pub fn set_usual(&mut self, usual: f64) {
        self.steps.usual = usual;
        self.steps.known.clear();
    }

    /// Deviations α, q, V, θ.
    pub fn state(&self) -> SVector<f64, 4> {
        self.estimate.mean
    }

    /// Takes in a sample, and answers with what each output said beyond what was expected of it.
    ///
    /// # Errors
    /// In words: why it cannot; the filter is as it was.
    pub fn take(&mut self, sample: &Sample) -> Result<Vec<Option<f64>>, String> {
        let mut next = self.estimate;
        if let Some((t_us, input)) = self.before {
            let (step, noise) = self.steps.over(sample.t_us - t_us)?;
            let spread = Covariance::from_lower_triangle(&noise);
            next.predict(&step.a, &spread).map_err(|error| error.to_string())?;
            next.mean += step.b * SVector::from(input);
        }
        let mut innovations = vec![None; self.rows.len()];
        for (output, (row, variance)) in self.rows.iter().enumerate() {
            let Some(measured) = sample.measured[output] else { continue };
            let innovation = measured - row.dot(&next.mean).unwrap_or_default();
            next.update(row, innovation, *variance).map_err(|error| error.to_string())?;
            innovations[output] = Some(innovation);
        }
        self.estimate = next;
        self.before = Some((sample.t_us, sample.input));
        Ok(innovations)
    }
}

impl Assumed {
    /// Of usual sensors. What a file's C mixes of the states is as noisy as the mixture of their sensors.
    pub fn of_sensors(model: &Model, outputs: &[usize]) -> Self {
        let Noise { inputs, outputs: sigmas, .. } = Noise::SENSORS;
        let mixed = |&output: &usize| {
            let parts = model.outputs[output].1.iter().zip(&sigmas);
            parts.fold(0.0, |sum: f64, (part, sigma)| sum.hypot(part * sigma))
        };
        Self { inputs, outputs: outputs.iter().map(mixed).collect() }
    }
}

impl Model {
    /// What is taken from values: nothing, or of `absolute` ones the model's trim.
    ///
    /// # Errors
    /// [`Error::Usage`] if it has none.
    pub fn origin(&self, absolute: bool) -> Result<([f64; 4], [f64; 2]), Error> {
        match (absolute, self.trim) {
            (false, _) => Ok(([0.0; 4], [0.0; 2])),
            (true, Some(trim)) => Ok(trim),
            (true, None) => Err(Error::Usage(
                "--absolute needs a model with a trim: P1, or a file that has one".to_owned(),
            )),
        }
    }

    /// What an output measures of a state.
    pub fn output(&self, output: usize, state: &[f64; 4]) -> f64 {
        self.outputs[output].1.iter().zip(state).map(|(part, state)| part * state).sum()
    }
}
