//! A recorded flight with the model that explains it.

use std::path::Path;

use kestirim_observer_design::Complex;
use nalgebra::SVector;

use super::accounts::Accuracy;
use super::follow::{self, Assumed, Estimate, Followed};
use super::log::{self, Flight, Truth};
use super::model::Model;
use crate::Error;
use crate::metrics::rms;

/// A flight in deviations from its model's steady one.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The aircraft.
    pub model: Model,
    /// The log, in deviations.
    pub flight: Flight,
    /// What was really flown, as in its file.
    pub truth: Option<Truth>,
    /// State and input that were taken from the log.
    origin: ([f64; 4], [f64; 2]),
    /// What a reader should know of the log.
    doubts: Vec<String>,
}

impl Recording {
    /// Reads all files; with `absolute` values the model's trim is taken from them.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(
        log: &Path,
        model: &Path,
        truth: Option<&Path>,
        absolute: bool,
    ) -> Result<Self, Error> {
        let model = Model::read(model)?;
        // Before the files are read, which may take a while.
        model.origin(absolute)?;
        let names: Vec<&str> = model.outputs.iter().map(|(name, _)| name.as_str()).collect();
        let flight = log::read(log, &names)?;
        let truth = truth.map(log::read_truth).transpose()?;
        Self::new(model, flight, truth, absolute)
    }

    /// From what was read.
    ///
    /// # Errors
    /// [`Error::Usage`] if values are `absolute` and the model has no trim.
    pub fn new(
        model: Model,
        mut flight: Flight,
        truth: Option<Truth>,
        absolute: bool,
    ) -> Result<Self, Error> {
        let origin = model.origin(absolute)?;
        let mut doubts = Vec::new();
        if let (false, Some(trim)) = (absolute, model.trim) {
            doubts.extend(looks_absolute(&flight, &model, trim.0[2]));
        }
        subtract(&mut flight, &model, origin);
        if flight.gaps > 0 {
            doubts.push(format!(
                "{} gaps are longer than one and a half intervals of {} s",
                flight.gaps, flight.interval_s
            ));
        }
        Ok(Self { model, flight, truth, origin, doubts })
    }

    /// What a reader should know.
    pub fn warnings(&self) -> Vec<String> {
        self.doubts.clone()
    }

    /// Of the outputs that the log has.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.flight.outputs.iter().map(|&output| self.model.outputs[output].0.as_str())
    }

    /// By a Kalman filter; what is not said of its noise is that of usual sensors.
    ///
    /// # Errors
    /// In words: why it cannot.
    pub fn kalman(
        &self,
        inputs: Option<[f64; 2]>,
        outputs: Option<[f64; 4]>,
    ) -> Result<Followed, String> {
        follow::kalman(&self.model, &self.flight, &self.assumed(inputs, outputs))
    }

    /// What a filter takes the noise for.
    pub fn assumed(&self, inputs: Option<[f64; 2]>, outputs: Option<[f64; 4]>) -> Assumed {
        let measured = &self.flight.outputs;
        let usual = Assumed::of_sensors(&self.model, measured);
        let given = |all: [f64; 4]| measured.iter().map(|&output| all[output]).collect();
        Assumed {
            inputs: inputs.unwrap_or(usual.inputs),
            outputs: outputs.map_or(usual.outputs, given),
        }
    }

    /// By an observer with these poles, 1/s.
    ///
    /// # Errors
    /// In words: why it cannot.
    pub fn observer(&self, poles: [Complex<f64>; 4]) -> Result<Followed, String> {
        follow::observer(&self.model, &self.flight, poles)
    }

    /// An estimate as the log has its values.
    pub fn absolute(&self, estimate: &Estimate) -> SVector<f64, 4> {
        estimate.state + SVector::from(self.origin.0)
    }

    /// Inputs of the log as they were before the trim was taken.
    pub fn inputs(&self) -> impl Iterator<Item = (i64, [f64; 2])> {
        let steady = self.origin.1;
        let absolute = move |input: [f64; 2]| std::array::from_fn(|i| input[i] + steady[i]);
        self.flight.samples.iter().map(move |sample| (sample.t_us, absolute(sample.input)))
    }

    /// Rows of the log as they were before the trim was taken: of each output, or nothing.
    pub fn measured(&self) -> impl Iterator<Item = (i64, Vec<Option<f64>>)> {
        let steady: Vec<f64> = self.flight.outputs.iter().map(|&o| self.steady(o)).collect();
        self.flight.samples.iter().map(move |sample| {
            let values = sample.measured.iter().zip(&steady);
            (sample.t_us, values.map(|(value, steady)| value.map(|v| v + steady)).collect())
        })
    }

    fn steady(&self, output: usize) -> f64 {
        self.model.output(output, &self.origin.0)
    }

    /// Errors at times that log and truth share: estimated less true, of the states that are known.
    pub fn errors(&self, estimates: &[Estimate]) -> Vec<(i64, [Option<f64>; 4])> {
        let Some(truth) = &self.truth else { return Vec::new() };
        let error = |estimate: &Estimate| {
            let place = truth.binary_search_by_key(&estimate.t_us, |(t, _)| *t).ok()?;
            let (state, known) = (self.absolute(estimate), truth[place].1);
            let each = |column: usize| known[column].map(|known| state[column] - known);
            Some((estimate.t_us, std::array::from_fn(each)))
        };
        estimates.iter().filter_map(error).collect()
    }

    /// Root mean squares of these errors, if there is a truth.
    pub fn accuracy(&self, estimates: &[Estimate]) -> Option<Accuracy> {
        self.truth.as_ref()?;
        let errors = self.errors(estimates);
        let middle = estimates.get(estimates.len() / 2).map_or(0, |estimate| estimate.t_us);
        let since = |begin: i64| {
            std::array::from_fn(|column| {
                let counted = errors.iter().filter(|(t_us, _)| *t_us >= begin);
                let errors: Vec<f64> = counted.filter_map(|(_, errors)| errors[column]).collect();
                (!errors.is_empty()).then(|| rms(&errors))
            })
        };
        Some(Accuracy { samples: errors.len(), rmse: since(i64::MIN), late_rmse: since(middle) })
    }
}

/// Whether airspeeds are nearer to the steady one than to nothing.
fn looks_absolute(flight: &Flight, model: &Model, airspeed: f64) -> Option<String> {
    let column = flight.outputs.iter().position(|&output| model.outputs[output].0 == "V")?;
    let mut values: Vec<f64> =
        flight.samples.iter().filter_map(|sample| sample.measured[column]).collect();
    values.sort_by(f64::total_cmp);
    let middle = *values.get(values.len() / 2)?;
    (middle > 0.5 * airspeed).then(|| {
        format!("V is {middle} m/s where deviations from {airspeed} m/s are expected (--absolute)")
    })
}

fn subtract(flight: &mut Flight, model: &Model, (state, input): ([f64; 4], [f64; 2])) {
    let shown: Vec<f64> =
        flight.outputs.iter().map(|&output| model.output(output, &state)).collect();
    for sample in &mut flight.samples {
        sample.input = std::array::from_fn(|i| sample.input[i] - input[i]);
        for (measured, steady) in sample.measured.iter_mut().zip(&shown) {
            *measured = measured.map(|measured| measured - steady);
        }
    }
}
