//! Follows a live flight with the selected estimator.

use kestirim_replay::uav::{
    Error as Refusal, EstimatorKind, Follow, Model, Options, Sample, build,
};
use kestirim_telemetry::{Flight, Message};

use super::recording::log::LARGEST;
use super::recording::model;
use super::settings;
use super::track::refused;
use crate::Error;
use crate::system::{Files, Health, Online, Outcome, Plan, Settings};

/// The quantities in a [`Flight`] message, by the names of a model's outputs.
const MEASURED: [&str; 3] = ["q", "V", "theta"];
/// The ratio to the usual interval below which a shorter one becomes the usual one: samples were lost before.
const SHORTER: f64 = 0.75;

/// The model, the measurements used, and the settings of the estimator.
#[derive(Debug, Clone)]
pub(super) struct Flying {
    model: Model,
    /// The indices of the model's outputs that are used.
    outputs: Vec<usize>,
    /// The index of each output in a [`Flight`] message.
    places: Vec<usize>,
    origin: ([f64; 4], [f64; 2]),
    absolute: bool,
    options: Options,
}

impl Flying {
    /// A plan with a named model or one from a file.
    ///
    /// # Errors
    /// [`Error::Usage`] without a model, and errors in the model.
    pub(super) fn new(settings: &Settings, files: &Files) -> Result<Self, Error> {
        let file = files.one("model");
        if file.is_none() && !settings.is_given("model") {
            let problem = "--system uav needs a --model: P1, P2, P3 or a file";
            return Err(Error::Usage(problem.to_owned()));
        }
        let model = file.map(model::read).transpose()?;
        let model = model.unwrap_or_else(|| Model::of(settings.chosen("model")));
        let place = |(place, name): (usize, &&str)| {
            let output = model.outputs.iter().position(|(known, _)| known == name)?;
            Some((output, place))
        };
        let (outputs, places): (Vec<_>, Vec<_>) =
            MEASURED.iter().enumerate().filter_map(place).unzip();
        if outputs.is_empty() {
            let problem = "expected an output q, V or theta, which are what is sent".to_owned();
            let path = file.unwrap_or_else(|| "model".as_ref()).to_path_buf();
            return Err(Error::File { path, problem });
        }
        let absolute = settings.is_on("absolute");
        let origin = model.origin(absolute).map_err(refused)?;
        let options = settings::options(settings);
        if model.is_grid() && options.estimator == EstimatorKind::Luenberger {
            return Err(refused(Refusal::GridOfObserver));
        }
        let flying = Self { model, outputs, places, origin, absolute, options };
        flying.build()?;
        Ok(flying)
    }

    /// Converts a message to deviations; `None` if a number is implausible.
    fn sample(&self, flight: &Flight) -> Option<Sample> {
        let (state, input) = &self.origin;
        let measured = self.outputs.iter().zip(&self.places).map(|(&output, &place)| {
            Some(f64::from(flight.outputs[place]) - self.model.shown(output, self.absolute, state))
        });
        let sample = Sample {
            t_us: i64::try_from(flight.time_us).ok()?,
            input: [0, 1].map(|which| f64::from(flight.inputs[which]) - input[which]),
            measured: measured.collect(),
        };
        let numbers = sample.input.iter().chain(sample.measured.iter().flatten());
        numbers.copied().all(|number| number.abs() < LARGEST).then_some(sample)
    }
}

impl Plan for Flying {
    fn build(&self) -> Result<Box<dyn Online>, Error> {
        let estimator = build(&self.model, &self.outputs, &self.options);
        let estimator = estimator.map_err(|error| Error::Usage(error.to_string()))?;
        Ok(Box::new(Aeroplane {
            plan: self.clone(),
            estimator,
            last_us: None,
            usual_s: f64::INFINITY,
        }))
    }
}

/// The live estimator.
#[derive(Debug)]
struct Aeroplane {
    plan: Flying,
    estimator: Box<dyn Follow>,
    last_us: Option<i64>,
    usual_s: f64,
}

impl Aeroplane {
    fn follow(&mut self, flight: &Flight) -> Option<()> {
        let sample = self.plan.sample(flight)?;
        if let Some(last_us) = self.last_us {
            let interval_us = sample.t_us.checked_sub(last_us).filter(|interval| *interval > 0)?;
            let interval_s = interval_us as f64 * 1e-6;
            if interval_s < SHORTER * self.usual_s {
                self.usual_s = interval_s;
                self.estimator.set_usual(interval_s);
            }
        }
        self.estimator.take(&sample).ok()?;
        self.last_us = Some(sample.t_us);
        Some(())
    }
}

impl Online for Aeroplane {
    fn take(&mut self, message: &Message) -> Outcome {
        match message {
            Message::Flight(flight) => Outcome::taken(self.follow(flight).is_some()),
            _ => Outcome::NotMine,
        }
    }

    fn state(&self) -> Option<[f64; 4]> {
        self.last_us?;
        let state: [f64; 4] = self.estimator.estimate().into();
        Some(std::array::from_fn(|i| state[i] + self.plan.origin.0[i]))
    }

    fn health(&self) -> Option<Health> {
        self.last_us.and_then(|_| self.estimator.health())
    }
}
