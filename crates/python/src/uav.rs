//! The longitudinal state of an aircraft: α, q, V, θ from some sensors.

use kestirim_health::{Health, Reason};
use kestirim_observer_design::{Complex, Discrete};
use kestirim_replay::Finding;
use kestirim_replay::uav::{
    Deviations, Error, EstimatorKind, Followed, Log, MOST_OUTPUTS, Model, Options, Plant,
    STATE_COLUMNS, Sample, check,
};
use kestirim_uav_estimator::Dynamics;
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::SMatrix;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{
    Line, Results, Table, code, microseconds, reasons, rows, scalar, sentences, values,
};
use crate::error::{KestirimError, refused, refused_at, unknown};

/// The matrices A and B of a known aircraft, and the state and input of its steady flight, if known.
#[pyfunction]
pub(crate) fn uav_model<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
    let plant = match name {
        "P1" => Plant::P1,
        "P2" => Plant::P2,
        "P3" => Plant::P3,
        _ => return Err(unknown("model", name, "'P1', 'P2', 'P3' or a UavModel")),
    };
    let StateSpace { a, b } = plant.model();
    let of_rows = |row: usize| std::array::from_fn::<f64, 4, _>(|column| a[(row, column)]);
    let a = (0..4).map(of_rows).collect();
    let b = (0..4).map(|row| [b[(row, 0)], b[(row, 1)]]).collect();
    let trim = Model::of(plant).trim;
    Ok(Results::new(py).table::<4>("a", a)?.table::<2>("b", b)?.with("trim", trim)?.done())
}

/// Estimates the states of a flight. Values are absolute if `trim` is given, which is then subtracted; otherwise they
/// are deviations from the model's steady flight.
#[pyfunction]
#[pyo3(signature = (t, inputs, measured, a, b, c, interval, trim, estimator, poles, input_noise, output_noise, ratio, scalar))]
pub(crate) fn uav<'py>(
    py: Python<'py>,
    t: Line<'py>,
    inputs: Table<'py>,
    measured: Table<'py>,
    a: Table<'py>,
    b: Table<'py>,
    c: Table<'py>,
    interval: Option<f64>,
    trim: Option<([f64; 4], [f64; 2])>,
    estimator: &str,
    poles: Vec<(f64, f64)>,
    input_noise: Option<[f64; 2]>,
    output_noise: Option<Line<'py>>,
    ratio: f64,
    scalar: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let c = rows::<4>(&c)?;
    if c.is_empty() || c.len() > MOST_OUTPUTS {
        let sentence = format!("expected one to {MOST_OUTPUTS} outputs, found {}", c.len());
        return Err(KestirimError::new_err(sentence));
    }
    let poles: Vec<_> = poles.into_iter().map(|(re, im)| Complex { re, im }).collect();
    let noise = output_noise.as_ref().map(values).transpose()?;
    let options = Options {
        estimator: match estimator {
            "kalman" => EstimatorKind::Kalman,
            "luenberger" => EstimatorKind::Luenberger,
            _ => return Err(unknown("estimator", estimator, "'kalman' or 'luenberger'")),
        },
        poles: <[Complex<f64>; 4]>::try_from(poles)
            .map_err(|poles| refused(format!("poles: expected 4, found {}", poles.len())))?,
        inputs: input_noise,
        // Outputs that are never measured fill the rest.
        outputs: noise.map(|sigmas| std::array::from_fn(|i| sigmas.get(i).copied().unwrap_or(1.0))),
        ratio,
        scalar: self::scalar(scalar)?,
    };
    let outputs = c.iter().enumerate().map(|(output, row)| (name(output, row), *row));
    let dynamics = dynamics(rows(&a)?, rows(&b)?, interval)?;
    let model = Model { dynamics, outputs: outputs.collect(), trim, extended: None };
    let samples = samples(values(&t)?, rows(&inputs)?, values(&measured)?, c.len());
    let (flight, followed, findings) = py
        .detach(|| {
            let log = Log::new((0..model.outputs.len()).collect(), samples)?;
            let findings = check(&log, Some(&model));
            let flight = Deviations::new(model, log, None, trim.is_some())?;
            let followed = flight.follow(&options)?;
            Ok((flight, followed, findings))
        })
        .map_err(unfollowed)?;
    results(py, &flight, &followed, &findings)
}

fn dynamics(a: &[[f64; 4]], b: &[[f64; 2]], interval: Option<f64>) -> PyResult<Dynamics> {
    let a = SMatrix::from_fn(|row, column| a[row][column]);
    let b = SMatrix::from_fn(|row, column| b[row][column]);
    match interval {
        None => Ok(Dynamics::Continuous(StateSpace { a, b })),
        Some(interval) if interval > 0.0 => {
            Ok(Dynamics::Discrete { step: Discrete { a, b }, interval })
        }
        Some(interval) => Err(KestirimError::new_err(format!(
            "interval: expected one above 0 s, found {interval}"
        ))),
    }
}

/// The name of the state that a row of C selects, else the number of the output.
fn name(output: usize, row: &[f64; 4]) -> String {
    let states = (0..4).zip(STATE_COLUMNS);
    let is_state = |state: usize| (0..4).all(|i| row[i] == f64::from(u8::from(i == state)));
    let state = states.into_iter().find(|(state, _)| is_state(*state));
    state.map_or_else(|| format!("output {output}"), |(_, name)| name.to_owned())
}

/// The samples of a log; values that are NaN were not measured.
fn samples(t: &[f64], inputs: &[[f64; 2]], measured: &[f64], outputs: usize) -> Vec<Sample> {
    let lines = t.iter().zip(inputs).zip(measured.chunks_exact(outputs));
    let known = |value: &f64| Some(*value).filter(|value| !value.is_nan());
    let sample = |((t, input), measured): ((&f64, &[f64; 2]), &[f64])| Sample {
        t_us: microseconds(*t),
        input: *input,
        measured: measured.iter().map(known).collect(),
    };
    lines.map(sample).collect()
}

fn unfollowed(error: Error) -> PyErr {
    match error {
        Error::NotLater { index } | Error::Sample { index, .. } => refused_at(index, error),
        other => refused(other),
    }
}

fn results<'py>(
    py: Python<'py>,
    flight: &Deviations,
    followed: &Followed,
    findings: &[Finding],
) -> PyResult<Bound<'py, PyDict>> {
    let Followed { estimates, innovations, rejected, .. } = followed;
    let lines: Vec<Health> = followed.lines().collect();
    let seconds = estimates.iter().map(|estimate| estimate.t_us as f64 / 1e6);
    let states = estimates.iter().map(|estimate| flight.absolute(estimate).into());
    let sigmas = estimates.iter().map(|it| it.sigma.map_or([f64::NAN; 4], <[f64; 4]>::from));
    let (count, outputs) = (estimates.len(), innovations.len());
    let all = (0..count).flat_map(|line| innovations.iter().map(move |output| output[line]));
    let of_all = Finding::doubts(findings);
    let (mut doubts, mut warnings) = (of_all, Vec::new());
    for (reason, sentence) in followed.doubted_lines() {
        doubts.add(reason);
        warnings.push(sentence);
    }
    for contradiction in followed.contradictions() {
        doubts.add(Reason::Innovations);
        warnings.push(contradiction.sentence(flight.names()));
    }
    warnings.extend(sentences(findings));
    warnings.extend(flight.looks_absolute.map(|[airspeed, steady]| {
        format!(
            "V is {airspeed} m/s where deviations from {steady} m/s are expected (absolute=True)"
        )
    }));
    Ok(Results::new(py)
        .line("t", seconds.collect())?
        .table("state", states.collect::<Vec<[f64; 4]>>())?
        .table("sigma", sigmas.collect())?
        .shaped(
            "innovations",
            all.map(|innovation| innovation.unwrap_or(f64::NAN)).collect(),
            [count, outputs],
        )?
        .line("rejected", rejected.iter().map(|count| i64::from(*count)).collect())?
        .line(
            "health",
            lines.iter().map(|health| code(health.state().max(of_all.state()))).collect(),
        )?
        .words("warnings", warnings)?
        .words("reasons", reasons(doubts))?
        .done())
}
