//! Logs of flights, and their true states.

use std::path::Path;

use kestirim_import::Options;
use kestirim_import::flight::{self, Flight};
use kestirim_replay::uav::{Log, STATE_COLUMNS, Sample, Truth};

use crate::Error;
use crate::table::{self, Column, Found, Header};
use crate::text::{self, printable};

/// The usual range of the time between samples of an aircraft's sensors (s).
const USUAL_STEP_S: [f64; 2] = [5e-4, 2.0];
/// The largest plausible value of an aircraft's sensor, in any unit.
pub(in crate::systems::uav) const LARGEST: f64 = 1e6;

/// Reads the log of an autopilot, or a table with columns `t`, `delta_e`, `delta_t` and any of the model's outputs.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read(path: &Path, names: &[&str], options: &Options) -> Result<(Log, Found), Error> {
    let bytes = text::unpacked(path)?;
    let flight = flight::read(&bytes, options).map_err(|error| table::refused(path, &error))?;
    let (outputs, samples, found) = match flight {
        Some(flight) => of_autopilot(path, names, flight)?,
        None => of_table(path, &bytes, names, options)?,
    };
    if samples.iter().flat_map(|sample| &sample.measured).all(Option::is_none) {
        let problem = "expected measurements, found none in any line".to_owned();
        return Err(Error::File { path: path.to_path_buf(), problem });
    }
    let log = Log::new(outputs, samples)
        .map_err(|error| Error::File { path: path.to_path_buf(), problem: error.to_string() })?;
    Ok((log, found))
}

/// The indices of the outputs, the samples, and how they were read.
type Contents = (Vec<usize>, Vec<Sample>, Found);

/// Selects the model's outputs that are states logged by an autopilot.
fn of_autopilot(path: &Path, names: &[&str], flight: Flight) -> Result<Contents, Error> {
    let state = |name: &str| STATE_COLUMNS.iter().position(|state| *state == name);
    let columns: Vec<_> = names
        .iter()
        .enumerate()
        .filter_map(|(output, name)| Some((output, state(name).filter(|&it| flight.has[it])?)))
        .collect();
    let has: Vec<_> = (0..4).filter(|&it| flight.has[it]).map(|it| STATE_COLUMNS[it]).collect();
    if columns.is_empty() {
        let (names, has) = (names.join(", "), has.join(", "));
        let problem = format!("expected at least one of {names}, found {has}");
        return Err(Error::File { path: path.to_path_buf(), problem });
    }
    let is_small = |value: &f64| value.abs() <= LARGEST;
    let sample = |row: &flight::Row| Sample {
        t_us: row.time_us,
        input: row.input,
        measured: columns.iter().map(|&(_, state)| row.state[state].filter(is_small)).collect(),
    };
    let rows = flight.rows.iter().filter(|row| row.input.iter().all(is_small));
    let samples = rows.map(sample).collect();
    let outputs = columns.iter().map(|(output, _)| *output).collect();
    let found = Found { import: flight.conclusions, warnings: flight.damage.sentences() };
    Ok((outputs, samples, found))
}

fn of_table(
    path: &Path,
    bytes: &[u8],
    names: &[&str],
    options: &Options,
) -> Result<Contents, Error> {
    let mut samples: Vec<Sample> = Vec::new();
    let mut outputs = Vec::new();
    let found = table::parse(
        path,
        bytes,
        &table::Log { what: "a recorded flight", usual_step_s: Some(USUAL_STEP_S), options },
        |header| {
            let inputs = header.require(["t", "delta_e", "delta_t"])?;
            let columns = measured_columns(header, names)?;
            if columns.is_empty() {
                return Err(header.lacks(&names.join(" or ")));
            }
            Ok((inputs, columns))
        },
        |([t, elevator, throttle], columns), row| {
            outputs = columns.iter().map(|(output, _)| *output).collect();
            let number = |name: &str, column: Column| {
                let value = row.number(name, column)?;
                if value.abs() > LARGEST {
                    return Err(row.line.error(format!("expected {name} below a million")));
                }
                Ok(value)
            };
            let t_us = row.time_us(*t)?;
            if samples.last().is_some_and(|last| last.t_us >= t_us) {
                return Err(row.line.error("expected a later time than on the line before"));
            }
            let input = [number("delta_e", *elevator)?, number("delta_t", *throttle)?];
            let measured = columns.iter().map(|&(output, column)| {
                if row.is_empty(column) {
                    Ok(None)
                } else {
                    number(names[output], column).map(Some)
                }
            });
            samples.push(Sample { t_us, input, measured: measured.collect::<Result<_, _>>()? });
            Ok(())
        },
    )?;
    Ok((outputs, samples, found))
}

fn measured_columns(header: &Header<'_>, names: &[&str]) -> Result<Vec<(usize, Column)>, Error> {
    let mut columns = Vec::new();
    for (output, name) in names.iter().enumerate() {
        if let Some(column) = header.find(name)? {
            columns.push((output, column));
        } else if let Some(other) = header.with_unit(name) {
            let found = printable(other);
            return Err(header.error(format!(
                "expected {name} with one of its units, or in that of the model (m, s, rad) under this name alone, found {found}"
            )));
        }
    }
    Ok(columns)
}

/// Reads columns `t` and some of `alpha`, `q`, `V`, `theta`.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read_truth(path: &Path) -> Result<Truth, Error> {
    let mut truth = Truth::new();
    table::read(
        path,
        "true states",
        |header| {
            let [t] = header.require(["t"])?;
            let columns = measured_columns(header, &STATE_COLUMNS)?;
            if columns.is_empty() {
                return Err(header.lacks(&STATE_COLUMNS.join(" or ")));
            }
            Ok((t, columns))
        },
        |(t, columns), row| {
            let mut states = [None; 4];
            for &(state, column) in columns {
                if !row.is_empty(column) {
                    let value = row.number(STATE_COLUMNS[state], column)?;
                    if value.abs() > LARGEST {
                        let name = STATE_COLUMNS[state];
                        return Err(row.line.error(format!("expected {name} below a million")));
                    }
                    states[state] = Some(value);
                }
            }
            let t_us = row.time_us(*t)?;
            if truth.last().is_some_and(|(last, _)| *last >= t_us) {
                return Err(row.line.error("expected a later time than on the line before"));
            }
            truth.push((t_us, states));
            Ok(())
        },
    )?;
    Ok(truth)
}
