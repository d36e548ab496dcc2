//! A recorded flight, followed by both estimators.

use std::path::{Path, PathBuf};

use nalgebra::SVector;

use super::super::follow::{Estimate, Followed};
use super::super::log::{self, Flight, Truth};
use super::super::model::{Model, STATE_COLUMNS};
use super::super::plant::{STATE_UNITS, STATES};
use super::super::recording::Recording;
use super::super::report::shown;
use super::super::scenario::Noise;
use super::controls::{self, complex, estimators};
use super::figures::{self, KALMAN, LUENBERGER, Line, State, in_bands};
use super::poles;
use crate::Error;
use crate::explore::{Answer, Control, Explorer, Settings};

/// What was read.
#[derive(Debug)]
pub(super) struct Recorded {
    log: PathBuf,
    /// None: one of the plants, by choice.
    model: Option<Model>,
    flight: Flight,
    truth: Option<Truth>,
}

impl Recorded {
    /// Reads the files.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub(super) fn open(
        log: &Path,
        model: Option<PathBuf>,
        truth: Option<&Path>,
    ) -> Result<Self, Error> {
        let model = model.map(|path| Model::read(&path)).transpose()?;
        let names = model.as_ref().map_or_else(
            || STATE_COLUMNS.to_vec(),
            |model| model.outputs.iter().map(|(name, _)| name.as_str()).collect(),
        );
        let flight = log::read(log, &names)?;
        let truth = truth.map(log::read_truth).transpose()?;
        Ok(Self { log: log.to_path_buf(), model, flight, truth })
    }

    fn recording(&self, settings: &Settings) -> Result<Recording, Error> {
        let model = match &self.model {
            Some(model) => model.clone(),
            None => Model::read(Path::new(settings.choice("plant")))?,
        };
        let absolute = settings.is_on("absolute");
        Recording::new(model, self.flight.clone(), self.truth.clone(), absolute)
    }
}

impl Explorer for Recorded {
    fn controls(&self) -> Vec<Control> {
        let mut controls = Vec::new();
        controls.extend(self.model.is_none().then(controls::plant));
        if self.model.as_ref().is_none_or(|model| model.trim.is_some()) {
            controls.push(Control::switch(
                "absolute",
                "values are absolute, not deviations",
                false,
            ));
        }
        controls.extend(estimators());
        controls
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let recording = self.recording(settings)?;
        let inputs = Noise::SENSORS.inputs.map(|sigma| sigma * settings.number("ratio").sqrt());
        let poles = controls::poles(settings);
        let failed = |problem| Error::File { path: self.log.clone(), problem };
        let kalman = recording.kalman(Some(inputs), None).map_err(failed)?;
        let mut answer = Answer { warnings: recording.warnings(), ..Answer::default() };
        let luenberger = recording.observer(complex(poles)).unwrap_or_else(|problem| {
            answer.warnings.push(format!("no Luenberger observer: {problem}"));
            Followed::default()
        });
        tell(&mut answer, &recording, [(KALMAN.0, &kalman), (LUENBERGER.0, &luenberger)]);
        answer.figures.extend(figures::states(states(&recording, &kalman, &luenberger)));
        let begin = self.flight.samples.first().map_or(0, |sample| sample.t_us);
        let error = |followed: &Followed| -> Line {
            let errors = recording.errors(&followed.estimates);
            errors.iter().map(|(t_us, errors)| (seconds(*t_us, begin), in_bands(*errors))).unzip()
        };
        let end = self.flight.samples.last().map_or(0, |sample| sample.t_us);
        let end = seconds(end, begin);
        answer.figures.push(figures::error(error(&kalman), error(&luenberger), end));
        let interval = recording.flight.interval_s;
        let step = recording.model.dynamics.over(interval, interval, &inputs.into());
        let step = step.map_err(|error| failed(error.to_string()))?;
        let outputs: Vec<_> =
            recording.flight.outputs.iter().map(|&o| recording.model.outputs[o].1).collect();
        let sigmas = recording.assumed(Some(inputs), None).outputs;
        let (outputs, sigmas) = (&outputs[..], &sigmas[..]);
        let filter = poles::Settled { step, outputs, sigmas, interval }.poles();
        let observer = poles.map(|pole| [pole, 0.0]);
        let observer = if luenberger.estimates.is_empty() { &[][..] } else { &observer[..] };
        answer.figures.push(figures::poles(
            &poles::of(&step.transition.a, interval),
            &filter,
            observer,
        ));
        Ok(answer)
    }
}

fn tell(answer: &mut Answer, recording: &Recording, followed: [(&str, &Followed); 2]) {
    let flight = &recording.flight;
    answer.fact("lines", format!("{} at {} s", flight.samples.len(), flight.interval_s));
    let names = STATES.join(", ");
    for (name, followed) in followed {
        let Some(last) = followed.estimates.last() else { continue };
        answer.fact(format!("{name}: last {names}"), shown(recording.absolute(last).into()));
        for (output, innovations) in recording.names().zip(&followed.innovations) {
            let rms = crate::metrics::rms(innovations);
            answer.fact(format!("{name}: innovations of {output}"), format!("{rms:.2e}"));
        }
        let Some(accuracy) = recording.accuracy(&followed.estimates) else { continue };
        if accuracy.samples == 0 {
            answer.warnings.push("no time of the truth is one of the log's".to_owned());
        }
        for (state, rmse) in accuracy.rmse.iter().enumerate() {
            if let Some(rmse) = rmse {
                let (symbol, unit) = (STATES[state], STATE_UNITS[state]);
                answer.fact(format!("{name}: RMSE of {symbol}"), format!("{rmse:.2e} {unit}"));
            }
        }
    }
}

fn states(recording: &Recording, kalman: &Followed, luenberger: &Followed) -> [State; 4] {
    let begin = recording.flight.samples.first().map_or(0, |sample| sample.t_us);
    std::array::from_fn(|state| {
        // An output that is a state by itself; what a file's C mixes has no axis here.
        let column = recording.flight.outputs.iter().position(|&output| {
            let row = recording.model.outputs[output].1;
            row[state] == 1.0 && row.iter().filter(|part| **part != 0.0).count() == 1
        });
        let measured = column.map_or_else(Line::default, |column| {
            let rows = recording.measured();
            rows.filter_map(|(t_us, row)| Some((seconds(t_us, begin), row[column]?))).unzip()
        });
        let truth = recording.truth.iter().flatten();
        let known = truth.filter_map(|(t_us, known)| Some((seconds(*t_us, begin), known[state]?)));
        let estimated = |estimates: &[Estimate]| -> Line {
            let value = |estimate: &Estimate| -> SVector<f64, 4> { recording.absolute(estimate) };
            estimates.iter().map(|e| (seconds(e.t_us, begin), value(e)[state])).unzip()
        };
        State {
            measured,
            truth: known.unzip(),
            kalman: estimated(&kalman.estimates),
            luenberger: estimated(&luenberger.estimates),
        }
    })
}

/// Since the log's first line.
fn seconds(t_us: i64, begin: i64) -> f64 {
    (t_us - begin) as f64 / 1e6
}
