//! Estimates along a recorded flight.

use kestirim_observer_design::Complex;
use kestirim_uav_estimator::{self as uav, Error, FlightFilter, FlightObserver};
use nalgebra::{SMatrix, SVector};

use super::design::discrete;
use super::log::{Flight, Sample};
use super::model::{MOST_OUTPUTS, Model};
use super::scenario::Noise;

/// Intervals of a log of which the steps are kept.
const KEPT: usize = 512;

/// A Kalman filter with room for as many outputs as a model may have.
pub type Filter = FlightFilter<f64, MOST_OUTPUTS, KEPT>;

/// An estimate, after its line was taken in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// µs.
    pub t_us: i64,
    /// Deviations α, q, V, θ.
    pub state: SVector<f64, 4>,
}

/// Of a flight: estimates, and what the measurements said beyond what was expected of them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Followed {
    /// One a line.
    pub estimates: Vec<Estimate>,
    /// Of each of the log's outputs.
    pub innovations: Vec<Vec<f64>>,
}

impl Followed {
    fn new(flight: &Flight) -> Self {
        Self { estimates: Vec::new(), innovations: vec![Vec::new(); flight.outputs.len()] }
    }

    fn add(
        &mut self,
        t_us: i64,
        state: SVector<f64, 4>,
        innovations: impl IntoIterator<Item = Option<f64>>,
    ) {
        for (all, innovation) in self.innovations.iter_mut().zip(innovations) {
            all.extend(innovation);
        }
        self.estimates.push(Estimate { t_us, state });
    }
}

/// Standard deviations of white noise: of δe, δt, and of each of the log's outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumed {
    /// On the inputs, a sample.
    pub inputs: [f64; 2],
    /// On the outputs.
    pub outputs: Vec<f64>,
}

impl Assumed {
    /// Of usual sensors. What a file's C mixes of the states is as noisy as the mixture of their sensors.
    pub fn of_sensors(model: &Model, outputs: &[usize]) -> Self {
        let mixed = |&output: &usize| Noise::SENSORS.of_output(&model.outputs[output].1);
        Self { inputs: Noise::SENSORS.inputs, outputs: outputs.iter().map(mixed).collect() }
    }
}

/// A Kalman filter of these outputs of a model, measured every `usual` seconds.
///
/// # Errors
/// Why there is none.
pub fn filter(
    model: &Model,
    outputs: &[usize],
    assumed: &Assumed,
    usual: f64,
) -> Result<Box<Filter>, Error> {
    // Outputs that are never measured fill the rest.
    let sigma = |output: usize| assumed.outputs.get(output).copied().unwrap_or(1.0);
    let noise = uav::Noise {
        inputs: assumed.inputs.into(),
        outputs: SVector::from_fn(|output, _| sigma(output)),
    };
    Ok(Box::new(Filter::new(&model.dynamics, &rows(model, outputs), &noise, usual)?))
}

/// By a Kalman filter whose estimate the first lines decide.
///
/// # Errors
/// In words: why it cannot.
pub fn kalman(model: &Model, flight: &Flight, assumed: &Assumed) -> Result<Followed, String> {
    let mut filter = filter(model, &flight.outputs, assumed, flight.interval_s).map_err(words)?;
    let mut followed = Followed::new(flight);
    for sample in &flight.samples {
        let innovations = filter.take(&sized(sample)).map_err(words)?;
        let innovations = innovations.map(|innovation| innovation.map(|it| it.innovation));
        followed.add(sample.t_us, filter.filter().estimate(), innovations);
    }
    Ok(followed)
}

/// By an observer with these poles, 1/s, that starts at what the first line measures.
///
/// # Errors
/// In words: why it cannot.
pub fn observer(
    model: &Model,
    flight: &Flight,
    poles: [Complex<f64>; 4],
) -> Result<Followed, String> {
    match flight.outputs.len() {
        1 => observer_of::<1>(model, flight, poles),
        2 => observer_of::<2>(model, flight, poles),
        3 => observer_of::<3>(model, flight, poles),
        _ => observer_of::<4>(model, flight, poles),
    }
    .map_err(words)
}

fn observer_of<const P: usize>(
    model: &Model,
    flight: &Flight,
    poles: [Complex<f64>; 4],
) -> Result<Followed, Error> {
    let c = rows::<P>(model, &flight.outputs);
    let usual = flight.interval_s;
    let mut observer = Box::new(FlightObserver::<f64, P, KEPT>::new(
        &model.dynamics,
        &c,
        &discrete(poles, usual),
        usual,
    )?);
    let mut followed = Followed::new(flight);
    for sample in &flight.samples {
        let innovations = observer.take(&sized(sample))?;
        followed.add(sample.t_us, observer.estimate(), innovations);
    }
    Ok(followed)
}

/// Rows of C that the log has; zero beyond.
fn rows<const P: usize>(model: &Model, outputs: &[usize]) -> SMatrix<f64, P, 4> {
    let row = |place: usize| outputs.get(place).map_or([0.0; 4], |&output| model.outputs[output].1);
    SMatrix::from_fn(|place, state| row(place)[state])
}

/// A line with room for P outputs.
pub fn sized<const P: usize>(sample: &Sample) -> uav::Sample<P> {
    uav::Sample {
        time_us: sample.t_us,
        input: sample.input.into(),
        measured: std::array::from_fn(|output| sample.measured.get(output).copied().flatten()),
    }
}

fn words(error: Error) -> String {
    error.to_string()
}
