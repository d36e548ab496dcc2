//! Feeds a flight to an estimator.

pub mod design;
pub mod deviations;
pub mod estimators;

use self::deviations::Deviations;
use self::estimators::{Estimate, Followed};
use super::recording::log::{Log, Sample};
use super::recording::model::Model;
use super::recording::{Logged, Recording};
use super::settings::{EstimatorKind, Options, Simulation};
use super::simulate::flight::{Flight, Moment};
use super::simulate::plant::Plant;
use super::simulate::scenario::INTERVAL_S;
use crate::Error;
use crate::system::{Health, Settings};

/// What an estimator made of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The flight as the estimator saw it.
    pub flight: Deviations,
    /// What came of it.
    pub followed: Followed,
}

impl Track {
    /// By the estimator that is set.
    ///
    /// # Errors
    /// Why there is none.
    pub fn of(recording: &Recording, settings: &Settings) -> Result<Self, Error> {
        Self::by(recording, settings, settings.chosen("estimator"))
    }

    /// By this estimator.
    ///
    /// # Errors
    /// Why there is none.
    pub fn by(
        recording: &Recording,
        settings: &Settings,
        estimator: EstimatorKind,
    ) -> Result<Self, Error> {
        let options = Options::of(settings).with(estimator);
        match recording {
            Recording::Logged(logged) => {
                let flight = deviations(logged, settings)?;
                let followed = flight.follow(&options);
                let followed = followed.map_err(|problem| recording.refused(problem))?;
                Ok(Self { flight, followed })
            }
            Recording::Synthetic(inputs) => {
                let simulation = Simulation::of(settings, *inputs);
                let (kind, flight) = (simulation.kind(&options), &simulation.flight);
                let moments = flight.follow(&kind, options.scalar, simulation.seed);
                let moments = moments.map_err(|problem| recording.refused(problem.to_string()))?;
                Ok(simulated(flight, &moments))
            }
        }
    }
}

fn deviations(logged: &Logged, settings: &Settings) -> Result<Deviations, Error> {
    let plant = settings.chosen::<Plant>("model");
    let model = logged.model.clone().unwrap_or_else(|| Model::of(plant));
    let (log, truth) = (logged.log.clone(), logged.truth.clone());
    let mut flight = Deviations::new(model, log, truth, settings.is_on("absolute"))?;
    if logged.model.is_none() && !settings.is_given("model") {
        flight.doubts.push(format!("no model is given: {} is assumed (--model)", plant.name()));
    }
    Ok(flight)
}

/// A simulated flight as a log would have it.
fn simulated(flight: &Flight, moments: &[Moment]) -> Track {
    let outputs: Vec<usize> = (4 - flight.outputs.count()..4).collect();
    let timed = || (0_i64..).map(|number| number * (INTERVAL_S * 1e6) as i64).zip(moments);
    let sample = |(t_us, moment): (i64, &Moment)| Sample {
        t_us,
        input: moment.sample.u.into(),
        measured: outputs.iter().map(|&output| Some(moment.sample.y[output])).collect(),
    };
    let innovations = outputs.iter().map(|&output| {
        moments.iter().map(|moment| moment.sample.y[output] - moment.estimate[output]).collect()
    });
    let followed = Followed {
        estimates: timed()
            .map(|(t_us, it)| Estimate { t_us, state: it.estimate, sigma: None })
            .collect(),
        innovations: innovations.collect(),
        rejected: vec![0; outputs.len()],
        healths: vec![Health::GOOD; moments.len()],
    };
    let truth = timed().map(|(t_us, it)| (t_us, <[f64; 4]>::from(it.sample.x).map(Some)));
    let samples = timed().map(sample).collect();
    let log = Log { outputs: outputs.clone(), samples, interval_s: INTERVAL_S, gaps: 0 };
    let flight = Deviations::simulated(Model::of(flight.plant), log, truth.collect());
    Track { flight, followed }
}
