//! The longitudinal motion of an aeroplane.

use kestirim_telemetry::{Flight, Message};

use super::{Estimator, Outcome};
use crate::Error;
use crate::live::options::Live;
use crate::systems::uav::follow::{Assumed, Filter, filter, sized};
use crate::systems::uav::log::{LARGEST, Sample};
use crate::systems::uav::model::Model;

/// What a [`Flight`] measures, by the names of a model's outputs.
const MEASURED: [&str; 3] = ["q", "V", "theta"];
/// An interval this much shorter than the usual one is the usual one: before, something was lost.
const SHORTER: f64 = 0.75;

/// The model, and what is taken from what is sent.
#[derive(Debug, Clone)]
pub(in crate::live) struct Plan {
    model: Model,
    /// Of the model, and where each stands in a [`Flight`].
    outputs: Vec<(usize, usize)>,
    origin: ([f64; 4], [f64; 2]),
    /// As it starts.
    filter: Box<Filter>,
}

impl Plan {
    pub(super) fn read(options: &Live) -> Result<Self, Error> {
        let Some(path) = &options.model else {
            return Err(Error::Usage(
                "--system uav needs a --model: P1, P2, P3 or a file".to_owned(),
            ));
        };
        let model = Model::read(path)?;
        let place = |(place, name): (usize, &&str)| {
            let output = model.outputs.iter().position(|(known, _)| known == name)?;
            Some((output, place))
        };
        let outputs: Vec<_> = MEASURED.iter().enumerate().filter_map(place).collect();
        if outputs.is_empty() {
            let problem = "expected an output q, V or theta, which are what is sent".to_owned();
            return Err(Error::File { path: path.clone(), problem });
        }
        let origin = model.origin(options.absolute)?;
        let measured: Vec<_> = outputs.iter().map(|(output, _)| *output).collect();
        let assumed = Assumed::of_sensors(&model, &measured);
        // What the interval is, the second sample tells.
        let filter = filter(&model, &measured, &assumed, 0.0)
            .map_err(|error| Error::File { path: path.clone(), problem: error.to_string() })?;
        Ok(Self { model, outputs, origin, filter })
    }

    pub(super) fn build(&self) -> Aeroplane {
        let filter = self.filter.clone();
        Aeroplane { plan: self.clone(), filter, last_us: None, usual_s: f64::INFINITY }
    }

    /// A flight in deviations; none if a number cannot have been measured.
    fn sample(&self, flight: &Flight) -> Option<Sample> {
        let (state, input) = &self.origin;
        let measured = self.outputs.iter().map(|&(output, place)| {
            Some(f64::from(flight.outputs[place]) - self.model.output(output, state))
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

/// A Kalman filter with the noise of usual sensors, as in a replay.
#[derive(Debug)]
pub(super) struct Aeroplane {
    plan: Plan,
    filter: Box<Filter>,
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
                self.filter.set_usual(interval_s);
            }
        }
        self.filter.take(&sized(&sample)).ok()?;
        self.last_us = Some(sample.t_us);
        Some(())
    }
}

impl Estimator for Aeroplane {
    fn take(&mut self, message: &Message) -> Outcome {
        match message {
            Message::Flight(flight) => Outcome::taken(self.follow(flight).is_some()),
            _ => Outcome::NotMine,
        }
    }

    fn state(&self) -> Option<[f64; 4]> {
        self.last_us?;
        let state: [f64; 4] = self.filter.filter().estimate().into();
        Some(std::array::from_fn(|i| state[i] + self.plan.origin.0[i]))
    }
}
