//! The path of a walking foot.

use kestirim_replay::Finding;
use kestirim_replay::pedestrian::{
    Error, Options, Sample, SensorClass, Stride, Trace, TrackerKind, check, trace,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{
    Line, Results, Table, code, microseconds, reasons, rows, scalar, sentences, values,
};
use crate::error::{KestirimError, refused_at, unknown};

/// Tracks a walk.
#[pyfunction]
#[pyo3(signature = (t, accel, gyro, mag, sensor, causal, tracker, contact_height, scalar))]
pub(crate) fn pedestrian<'py>(
    py: Python<'py>,
    t: Line<'py>,
    accel: Table<'py>,
    gyro: Table<'py>,
    mag: Option<Table<'py>>,
    sensor: &str,
    causal: bool,
    tracker: &str,
    contact_height: Option<f64>,
    scalar: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let options = Options {
        tracker: match tracker {
            "ekf" => TrackerKind::Ekf,
            "lite" => TrackerKind::Lite,
            _ => return Err(unknown("tracker", tracker, "'ekf' or 'lite'")),
        },
        sensor: match sensor {
            "industrial" => SensorClass::Industrial,
            "consumer" => SensorClass::Consumer,
            _ => return Err(unknown("sensor", sensor, "'industrial' or 'consumer'")),
        },
        contact_height_m: contact_height,
        causal,
        scalar: self::scalar(scalar)?,
        ..Options::default()
    };
    let samples = samples(values(&t)?, rows(&accel)?, rows(&gyro)?)?;
    let field = mag.as_ref().map(rows::<3>).transpose()?;
    // The heading is corrected afterwards, so not causally; and the heading of the other trackers does not drift at a
    // constant rate.
    let field = field.filter(|_| !causal && options.tracker == TrackerKind::Ekf);
    let found = py.detach(|| -> Result<(Trace, Vec<Finding>), Error> {
        let mut found = trace(&samples, &options)?;
        if let Some(field) = &field {
            found.walk.correct_heading(&samples, field, &options);
            found.turn_moments();
        }
        Ok((found, check(&samples)))
    });
    let (found, findings) = found.map_err(refused)?;
    results(py, &found, &findings)
}

/// Converts arrays to samples; refuses invalid times.
fn samples(t: &[f64], accel: &[[f64; 3]], gyro: &[[f64; 3]]) -> PyResult<Vec<Sample>> {
    let lines = t.iter().zip(accel).zip(gyro).enumerate();
    let sample = |(index, ((&t, &specific_force), &angular_rate))| {
        if !(0.0..=1e12).contains(&t) {
            return Err(refused_at(index, format!("expected a time from 0 s on, found {t}")));
        }
        Ok(Sample { time_us: microseconds(t) as u64, specific_force, angular_rate })
    };
    lines.map(sample).collect()
}

fn refused(error: Error) -> PyErr {
    match error {
        Error::Sample { index, source } => refused_at(index - 1, source),
        other => KestirimError::new_err(other.to_string()),
    }
}

fn results<'py>(
    py: Python<'py>,
    found: &Trace,
    findings: &[Finding],
) -> PyResult<Bound<'py, PyDict>> {
    let Trace { walk, moments } = found;
    let of = |number: fn(&Stride) -> f64| walk.strides.iter().map(number).collect::<Vec<_>>();
    let times = || walk.track.iter().map(|point| point.time_us);
    let seconds = |time_us: u64| time_us as f64 / 1e6;
    let of_all = Finding::doubts(findings);
    let least = of_all.state();
    let strides = Results::new(py)
        .line("t", walk.strides.iter().map(|stride| seconds(stride.time_us)).collect())?
        .table("position", walk.strides.iter().map(|stride| stride.position).collect())?
        .line("length", of(|stride| stride.length_m))?
        .line("duration", of(|stride| stride.duration_s))?
        .line("heading_change", of(|stride| stride.heading_change_rad))?
        .table("sigma", walk.strides.iter().map(|stride| stride.sigma_m).collect())?
        .done();
    Ok(Results::new(py)
        .line("t", times().map(seconds).collect())?
        .table("position", walk.track.iter().map(|point| point.position).collect())?
        .table("velocity", moments.iter().map(|moment| moment.velocity).collect())?
        .table("orientation", moments.iter().map(|moment| moment.orientation).collect())?
        .line("stance", moments.iter().map(|moment| moment.stance).collect())?
        .table("sigma", walk.sigmas_m(times()).collect())?
        .line("health", walk.healths().map(|state| code(state.max(least))).collect())?
        .with("strides", strides)?
        .with("path_length", walk.path_length_m)?
        .with("closure", walk.closure_m)?
        .with("heading_rate", walk.heading_rate)?
        .words("warnings", walk.warnings.iter().cloned().chain(sentences(findings)))?
        .words("reasons", reasons(walk.doubts.and(of_all)))?
        .done())
}
