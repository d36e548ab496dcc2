//! Estimates along a recorded flight.

use kestirim_luenberger::{CurrentGains, CurrentObserver, Plant};
use kestirim_observer_design::Complex;
use nalgebra::{SMatrix, SVector};

use super::design::luenberger;
use super::log::{Flight, Sample};
use super::model::Model;
use super::online::{Filter, Steps};

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

/// Standard deviations of white noise: of δe, δt, and of each of the log's outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumed {
    /// On the inputs, a sample.
    pub inputs: [f64; 2],
    /// On the outputs.
    pub outputs: Vec<f64>,
}

/// By a Kalman filter that starts at what the first line measures.
///
/// # Errors
/// In words: why it cannot.
pub fn kalman(model: &Model, flight: &Flight, assumed: &Assumed) -> Result<Followed, String> {
    let mut filter = Filter::new(model, &flight.outputs, assumed, flight.interval_s);
    let mut followed = empty(flight);
    for sample in &flight.samples {
        let innovations = filter.take(sample)?;
        for (all, innovation) in followed.innovations.iter_mut().zip(innovations) {
            all.extend(innovation);
        }
        followed.estimates.push(Estimate { t_us: sample.t_us, state: filter.state() });
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
}

fn observer_of<const P: usize>(
    model: &Model,
    flight: &Flight,
    poles: [Complex<f64>; 4],
) -> Result<Followed, String> {
    let mut steps = Steps::new(model, flight.interval_s, [0.0; 2]);
    let usual_us = (flight.interval_s * 1e6).round() as i64;
    let (plant, _) = steps.over(usual_us)?;
    let rows = rows(model, flight);
    let c = SMatrix::<f64, P, 4>::from_fn(|output, state| rows[output][state]);
    let predictor = luenberger(&plant, &c, poles, flight.interval_s).map_err(|e| e.to_string())?;
    // The same poles where the estimate is to have seen its own line.
    let backwards = plant.a.try_inverse().ok_or("the model's transition has no inverse")?;
    let gains = CurrentGains::new(&Plant { a: plant.a, b: plant.b, c }, &(backwards * predictor));
    let mut observer =
        CurrentObserver::<f64, 4, 2, P>::new(&gains, &start(&rows, &flight.samples[0]))
            .map_err(words)?;
    let mut followed = empty(flight);
    let mut before: Option<&Sample> = None;
    for sample in &flight.samples {
        if let Some(before) = before {
            let input = SVector::from(before.input);
            let interval_us = sample.t_us - before.t_us;
            if interval_us == usual_us {
                observer.predict(&input).map_err(words)?;
            } else {
                let (step, _) = steps.over(interval_us)?;
                let there = step.a * observer.estimate() + step.b * input;
                observer.reset(&there).map_err(words)?;
            }
        }
        // What was not measured is what was expected.
        let expected = c * observer.estimate();
        let measured = SVector::<f64, P>::from_fn(|output, _| {
            sample.measured[output].unwrap_or(expected[output])
        });
        let innovation = observer.correct(&measured).map_err(words)?;
        for (output, innovations) in followed.innovations.iter_mut().enumerate() {
            innovations.extend(sample.measured[output].map(|_| innovation[output]));
        }
        followed.estimates.push(Estimate { t_us: sample.t_us, state: *observer.estimate() });
        before = Some(sample);
    }
    Ok(followed)
}

fn words(error: kestirim_luenberger::Error) -> String {
    error.to_string()
}

fn empty(flight: &Flight) -> Followed {
    Followed { estimates: Vec::new(), innovations: vec![Vec::new(); flight.outputs.len()] }
}

/// Rows of C that the log has.
fn rows(model: &Model, flight: &Flight) -> Vec<[f64; 4]> {
    flight.outputs.iter().map(|&output| model.outputs[output].1).collect()
}

/// States that the first line measures by themselves; of the others nothing is known.
fn start(rows: &[[f64; 4]], first: &Sample) -> SVector<f64, 4> {
    let mut start = SVector::zeros();
    for (row, measured) in rows.iter().zip(&first.measured) {
        let single = row.iter().filter(|part| **part != 0.0).count() == 1;
        let state = row.iter().position(|part| *part != 0.0);
        if let (true, Some(state), Some(measured)) = (single, state, measured) {
            start[state] = measured / row[state];
        }
    }
    start
}
