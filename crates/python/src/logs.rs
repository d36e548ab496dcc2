//! Logs of inertial sensors in any format.

use std::path::PathBuf;
use std::str::FromStr;

use kestirim_import::inertial::{Conclusion, read};
use kestirim_import::{Columns, Format, Options, Units, unpacked};
use kestirim_replay::pedestrian::check;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Results, sentences};
use crate::error::{KestirimError, refused};

/// Reads a log in any known format.
#[pyfunction]
#[pyo3(signature = (path, columns, units, format, topic, strict))]
pub(crate) fn read_imu<'py>(
    py: Python<'py>,
    path: PathBuf,
    columns: Option<&str>,
    units: Option<&str>,
    format: Option<&str>,
    topic: Option<String>,
    strict: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let options = Options {
        columns: said::<Columns>("columns", columns)?.unwrap_or_default(),
        units: said::<Units>("units", units)?.unwrap_or_default(),
        format: said::<Format>("format", format)?,
        topic,
        strict,
    };
    let (log, faults) = py.detach(|| {
        let shown = path.display();
        let unread = |error: &dyn std::fmt::Display| refused(format!("{shown}: {error}"));
        let bytes = std::fs::read(&path).map_err(|error| unread(&error))?;
        let bytes = unpacked(bytes.into()).map_err(|error| unread(&error))?;
        let log = read(&bytes, &options).map_err(|error| unread(&error))?;
        let faults = sentences(&check(&log.samples));
        PyResult::Ok((log, faults))
    })?;
    let mag = log.magnetic_field();
    let warnings = log.damage.sentences().into_iter().chain(faults);
    let samples = &log.samples;
    let results = Results::new(py)
        .line("t", samples.iter().map(|sample| sample.time_us as f64 / 1e6).collect())?
        .table("accel", samples.iter().map(|sample| sample.specific_force).collect())?
        .table("gyro", samples.iter().map(|sample| sample.angular_rate).collect())?
        .words("understood", log.conclusions.iter().map(Conclusion::to_string))?
        .words("warnings", warnings)?;
    let results = match mag {
        Some(mag) => results.table("mag", mag)?,
        None => results.with("mag", py.None())?,
    };
    Ok(results.done())
}

/// Parses a statement about a log, in the syntax of the command line.
fn said<T: FromStr<Err: std::fmt::Display>>(name: &str, text: Option<&str>) -> PyResult<Option<T>> {
    let read = text.map(str::parse).transpose();
    read.map_err(|error: T::Err| KestirimError::new_err(format!("{name}: {error}")))
}
