//! Runs an estimator over a flight.

use kestirim_replay::uav::{
    self, Deviations, Estimate, EstimatorKind, Followed, Log, Model, Plant, Sample,
};

use kestirim_observer_design::riccati;
use kestirim_simulate::with_outputs;
use nalgebra::{SMatrix, SVector};

use super::recording::{Logged, Recording};
use super::settings::{NEEDS_TRIM, Simulation, options};
use super::simulate::design::Kind;
use super::simulate::flight::{Flight, Moment};
use super::simulate::scenario::INTERVAL_S;
use crate::Error;
use crate::system::{Health, Settings};

/// The estimator's results for a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The flight as the estimator saw it.
    pub flight: Deviations,
    /// The estimates and innovations.
    pub followed: Followed,
    /// Warnings about the log.
    pub warnings: Vec<String>,
}

impl Track {
    /// Tracks a flight with the estimator that is set.
    ///
    /// # Errors
    /// The reason why there is no track.
    pub fn of(recording: &Recording, settings: &Settings) -> Result<Self, Error> {
        Self::by(recording, settings, settings.chosen("estimator"))
    }

    /// Tracks a flight with a given estimator.
    ///
    /// # Errors
    /// The reason why there is no track.
    pub fn by(
        recording: &Recording,
        settings: &Settings,
        estimator: EstimatorKind,
    ) -> Result<Self, Error> {
        let options = options(settings).with(estimator);
        match recording {
            Recording::Logged(logged) => {
                let flight = deviations(logged, settings)?;
                let followed = flight.follow(&options);
                let followed = followed.map_err(|error| recording.refused(error.to_string()))?;
                let warnings = warnings(logged, settings, &flight);
                Ok(Self { flight, followed, warnings })
            }
            Recording::Synthetic(inputs) => {
                let simulation = Simulation::of(settings, *inputs);
                let (kind, flight) = (simulation.kind(&options), &simulation.flight);
                let moments = flight.follow(&kind, options.scalar, simulation.seed);
                let moments = moments.map_err(|problem| recording.refused(problem.to_string()))?;
                let mut track = simulated(flight, &moments);
                let normalised = with_outputs!(flight.outputs, normalised, flight, &kind, &moments);
                track.followed.normalised = normalised.unwrap_or_default();
                Ok(track)
            }
        }
    }
}

fn deviations(logged: &Logged, settings: &Settings) -> Result<Deviations, Error> {
    let plant = settings.chosen::<Plant>("model");
    let model = logged.model.clone().unwrap_or_else(|| Model::of(plant));
    let (log, truth) = (logged.log.clone(), logged.truth.clone());
    Deviations::new(model, log, truth, settings.is_on("absolute")).map_err(refused)
}

fn warnings(logged: &Logged, settings: &Settings, flight: &Deviations) -> Vec<String> {
    let absolute = flight.looks_absolute.map(|[airspeed, steady]| {
        format!("V is {airspeed} m/s where deviations from {steady} m/s are expected (--absolute)")
    });
    let Log { gaps, interval_s, .. } = flight.log;
    let missing =
        || format!("{gaps} gaps are longer than one and a half intervals of {interval_s} s");
    let is_assumed = logged.model.is_none() && !settings.is_given("model");
    let assumed = || {
        let plant = settings.chosen::<Plant>("model").name();
        format!("no model is given: {plant} is assumed (--model)")
    };
    let told = [absolute, (gaps > 0).then(missing), is_assumed.then(assumed)];
    told.into_iter().flatten().collect()
}

/// The error for settings that the estimator does not allow.
pub(super) fn refused(error: uav::Error) -> Error {
    Error::Usage(match error {
        uav::Error::NoTrim => format!("--absolute {NEEDS_TRIM}"),
        other => other.to_string(),
    })
}

/// The innovations of a simulated flight in standard deviations, as its Kalman filter expects them; empty for an
/// observer.
///
/// The innovations at one time have the joint covariance C P Cᵀ + R; its Cholesky factor decorrelates them, as if they
/// were processed one by one.
fn normalised<const P: usize>(
    c: &SMatrix<f64, P, 4>,
    flight: &Flight,
    kind: &Kind,
    moments: &[Moment],
) -> Option<Vec<Vec<f64>>> {
    let (Kind::Matched(noise) | Kind::TimeVarying(noise)) = kind else { return None };
    let plant = flight.plant.discrete(INTERVAL_S);
    let (q, r) = (noise.process(&plant), noise.measurement(c));
    let mut prior = match kind {
        Kind::TimeVarying(_) => {
            let off = SVector::from(flight.truth) - SVector::from(flight.start);
            SMatrix::from_diagonal(&off.component_mul(&off))
        }
        _ => riccati(&plant.a, c, &q, &r).ok()?.prior,
    };
    let mut normalised = vec![Vec::with_capacity(moments.len()); P];
    for moment in moments {
        let expected = (c * prior * c.transpose() + r).cholesky()?;
        let whitened = c * (moment.sample.y - moment.estimate);
        let whitened = expected.l().solve_lower_triangular(&whitened)?;
        for (all, one) in normalised.iter_mut().zip(whitened.iter()) {
            all.push(*one);
        }
        let gain = expected.solve(&(c * prior)).transpose();
        let posterior = prior - gain * c * prior;
        prior = plant.a * posterior * plant.a.transpose() + q;
    }
    Some(normalised)
}

/// A simulated flight in the form of a log.
fn simulated(flight: &Flight, moments: &[Moment]) -> Track {
    let outputs: Vec<usize> = (4 - flight.outputs.count()..4).collect();
    let timed = || (0_i64..).map(|number| number * (INTERVAL_S * 1e6) as i64).zip(moments);
    let sample = |(t_us, moment): (i64, &Moment)| Sample {
        t_us,
        input: moment.sample.u.into(),
        measured: outputs.iter().map(|&output| Some(moment.sample.y[output])).collect(),
    };
    let innovations = outputs.iter().map(|&output| {
        moments
            .iter()
            .map(|moment| Some(moment.sample.y[output] - moment.estimate[output]))
            .collect()
    });
    let followed = Followed {
        estimates: timed()
            .map(|(t_us, it)| Estimate { t_us, state: it.estimate, sigma: None })
            .collect(),
        innovations: innovations.collect(),
        rejected: vec![0; outputs.len()],
        healths: vec![Health::GOOD; moments.len()],
        ..Followed::default()
    };
    let truth = timed().map(|(t_us, it)| (t_us, <[f64; 4]>::from(it.sample.x).map(Some)));
    let samples = timed().map(sample).collect();
    let log = Log { outputs: outputs.clone(), samples, interval_s: INTERVAL_S, gaps: 0 };
    let flight = Deviations::simulated(Model::of(flight.plant), log, truth.collect());
    Track { flight, followed, warnings: Vec::new() }
}
