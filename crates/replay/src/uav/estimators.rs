//! Estimates along a recorded flight.

use kestirim_health::Health;
use kestirim_kalman::Innovation;
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{self as uav, FlightFilter, FlightObserver};
use nalgebra::{SMatrix, SVector};

use super::{
    Beside, Error, Extended, Log, MOST_OUTPUTS, Model, Noise, Options, Poles, Sample, discrete,
};
use crate::ScalarKind;

/// The number of different intervals of a log for which discretised steps are kept.
pub(super) const KEPT: usize = 512;

/// A Kalman filter with room for the largest number of outputs of a model.
pub(super) type Filter<T> = FlightFilter<T, MOST_OUTPUTS, KEPT>;

/// An estimate after a line of the log was processed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Time, µs.
    pub t_us: i64,
    /// The state as deviations of α, q, V, θ.
    pub state: SVector<f64, 4>,
    /// The standard deviations of the state, if the estimator knows them.
    pub sigma: Option<SVector<f64, 4>>,
}

/// The result of an estimator along a flight: estimates and innovations.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Followed {
    /// The estimates, one per line.
    pub estimates: Vec<Estimate>,
    /// The innovations of each of the log's outputs, one per line; `None` where it was not measured, or nothing was
    /// expected yet.
    pub innovations: Vec<Vec<Option<f64>>>,
    /// The number of times each output was rejected because it contradicted the estimate.
    pub rejected: Vec<u32>,
    /// How far the estimate of each line can be relied upon.
    pub healths: Vec<Health>,
    /// The innovations of each of the log's outputs in standard deviations, if the estimator knows them.
    pub normalised: Vec<Vec<f64>>,
    /// The quantities that were estimated in addition to the four states.
    pub beside: Vec<Beside>,
    /// Standard deviations (m/s) of the gusts along and across that the innovations support best.
    pub gust: Option<[f64; 2]>,
    /// The estimated airspeed (m/s) that is furthest beyond those of a grid of models, and the end of the grid; or furthest from that of
    /// a single model, and that one: if it is as far as [`Contradiction::Beyond`](super::Contradiction::Beyond) says.
    pub beyond: Option<[f64; 2]>,
}

impl Followed {
    pub(super) fn new(log: &Log) -> Self {
        let count = log.outputs.len();
        let (innovations, normalised) = (vec![Vec::new(); count], vec![Vec::new(); count]);
        Self { innovations, normalised, rejected: vec![0; count], ..Self::default() }
    }

    /// Adds innovations in standard deviations.
    pub(super) fn judge(&mut self, innovations: &[Option<Innovation<f64>>]) {
        for (all, innovation) in self.normalised.iter_mut().zip(innovations) {
            all.extend(innovation.map(|it| it.nis.sqrt().copysign(it.innovation)));
        }
    }

    pub(super) fn add(
        &mut self,
        estimate: Estimate,
        innovations: impl IntoIterator<Item = Option<f64>>,
        rejected: &[u32],
        health: Health,
    ) {
        for (all, innovation) in self.innovations.iter_mut().zip(innovations) {
            all.push(innovation);
        }
        for (all, rejected) in self.rejected.iter_mut().zip(rejected) {
            *all = *rejected;
        }
        self.healths.push(health);
        self.estimates.push(estimate);
    }
}

/// Assumed standard deviations of white noise on δe, δt and each of the log's outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumed {
    /// Noise of the inputs, per sample.
    pub inputs: [f64; 2],
    /// Noise of the outputs.
    pub outputs: Vec<f64>,
}

impl Assumed {
    /// The noise as set by the options, otherwise as the model says, otherwise that of usual sensors. What a file's C
    /// mixes of the states is as noisy as the mixture of their sensors.
    pub fn of(model: &Model, outputs: &[usize], options: &Options) -> Self {
        let extended = model.extended.as_deref();
        let said = |output: usize| Some(extended?.sigmas.as_ref()?[output]);
        let usual = |output: usize| Noise::SENSORS.of_output(&model.outputs[output].1);
        let given = |output: usize| options.outputs?.get(output).copied();
        let of_output = |&output: &usize| {
            given(output).or_else(|| said(output)).unwrap_or_else(|| usual(output))
        };
        let usual_inputs = || match extended {
            Some(Extended { inputs: Some(inputs), .. }) => *inputs,
            Some(Extended { process: Some(_), .. }) => [0.0; 2],
            _ => Noise::SENSORS.inputs,
        };
        Self {
            inputs: options.weighted(options.inputs.unwrap_or_else(usual_inputs)),
            outputs: outputs.iter().map(of_output).collect(),
        }
    }
}

/// A Kalman filter for the given outputs of a model, measured every `usual` seconds.
///
/// # Errors
/// Why it cannot be built.
pub(super) fn filter<T: Scalar>(
    model: &Model,
    outputs: &[usize],
    assumed: &Assumed,
    usual: f64,
) -> Result<Box<Filter<T>>, uav::Error> {
    // The remaining outputs are never measured.
    let sigma = |output: usize| assumed.outputs.get(output).copied().unwrap_or(1.0);
    let noise = uav::Noise {
        inputs: assumed.inputs.into(),
        outputs: SVector::from_fn(|output, _| sigma(output)),
    };
    Ok(Box::new(Filter::new(&model.dynamics, &rows(model, outputs), &noise, usual)?))
}

/// Runs a Kalman filter, whose initial estimate the first lines determine.
///
/// # Errors
/// [`Error::Estimator`] or [`Error::Sample`].
pub(super) fn kalman(
    model: &Model,
    log: &Log,
    assumed: &Assumed,
    scalar: ScalarKind,
) -> Result<Followed, Error> {
    match scalar {
        ScalarKind::F32 => kalman_in::<f32>(model, log, assumed),
        ScalarKind::F64 => kalman_in::<f64>(model, log, assumed),
        ScalarKind::Fixed => kalman_in::<Q16_16>(model, log, assumed),
    }
}

fn kalman_in<T: Scalar>(model: &Model, log: &Log, assumed: &Assumed) -> Result<Followed, Error> {
    let mut filter = filter::<T>(model, &log.outputs, assumed, log.interval_s)?;
    let mut followed = Followed::new(log);
    for (index, sample) in log.samples.iter().enumerate() {
        let innovations = filter.take(&sized(sample));
        let innovations = innovations.map_err(|source| Error::Sample { index, source })?;
        followed.judge(&innovations);
        let innovations = innovations.map(|innovation| innovation.map(|it| it.innovation));
        let now = filter.filter();
        let sigma = Some(now.sigma());
        let estimate = Estimate { t_us: sample.t_us, state: now.estimate(), sigma };
        followed.add(estimate, innovations, filter.rejected(), filter.health());
    }
    Ok(followed)
}

/// Runs an observer with these poles, 1/s, which starts at what the first line measures.
///
/// # Errors
/// [`Error::Estimator`] or [`Error::Sample`].
pub(super) fn observer(
    model: &Model,
    log: &Log,
    poles: Poles,
    scalar: ScalarKind,
) -> Result<Followed, Error> {
    match scalar {
        ScalarKind::F32 => observer_in::<f32>(model, log, poles),
        ScalarKind::F64 => observer_in::<f64>(model, log, poles),
        ScalarKind::Fixed => observer_in::<Q16_16>(model, log, poles),
    }
}

fn observer_in<T: Scalar>(model: &Model, log: &Log, poles: Poles) -> Result<Followed, Error> {
    match log.outputs.len() {
        1 => observer_of::<T, 1>(model, log, poles),
        2 => observer_of::<T, 2>(model, log, poles),
        3 => observer_of::<T, 3>(model, log, poles),
        4 => observer_of::<T, 4>(model, log, poles),
        5 => observer_of::<T, 5>(model, log, poles),
        6 => observer_of::<T, 6>(model, log, poles),
        7 => observer_of::<T, 7>(model, log, poles),
        _ => observer_of::<T, 8>(model, log, poles),
    }
}

fn observer_of<T: Scalar, const P: usize>(
    model: &Model,
    log: &Log,
    poles: Poles,
) -> Result<Followed, Error> {
    let (c, usual) = (rows::<P>(model, &log.outputs), log.interval_s);
    let poles = discrete(poles, usual);
    let mut observer =
        Box::new(FlightObserver::<T, P, KEPT>::new(&model.dynamics, &c, &poles, usual)?);
    let mut followed = Followed::new(log);
    for (index, sample) in log.samples.iter().enumerate() {
        let innovations = observer.take(&sized(&model.without_direct(sample, &log.outputs)));
        let innovations = innovations.map_err(|source| Error::Sample { index, source })?;
        let (state, sigma) = (observer.estimate(), None);
        let estimate = Estimate { t_us: sample.t_us, state, sigma };
        followed.add(estimate, innovations, observer.rejected(), observer.health());
    }
    Ok(followed)
}

/// The rows of C that are measured; the remaining rows are zero.
pub fn rows<const P: usize>(model: &Model, outputs: &[usize]) -> SMatrix<f64, P, 4> {
    let row = |place: usize| outputs.get(place).map_or([0.0; 4], |&output| model.outputs[output].1);
    SMatrix::from_fn(|place, state| row(place)[state])
}

/// A line of the log with room for P outputs.
pub(super) fn sized<const P: usize>(sample: &Sample) -> uav::Sample<P> {
    uav::Sample {
        time_us: sample.t_us,
        input: sample.input.into(),
        measured: std::array::from_fn(|output| sample.measured.get(output).copied().flatten()),
    }
}
