//! Recorded flights, and what is known of their truth.

use std::path::Path;

use kestirim_import::Options;
use kestirim_import::flight::{self, Flight};

use crate::Error;
use crate::systems::uav::recording::model::STATE_COLUMNS;
use crate::table::{self, Column, Found, Header, Log as Logged};
use crate::text;

/// Intervals that differ by less than this share from the usual one are jitter.
const JITTER: f64 = 0.1;
/// Share of intervals that must be the usual one.
const REGULAR: f64 = 0.75;
/// From this many usual intervals on, samples are missing.
const GAP: f64 = 1.5;
/// An aircraft's sensors are read so often, s.
const USUAL_STEP_S: [f64; 2] = [5e-4, 2.0];
/// No sensor of an aircraft measures more, in any unit.
pub(in crate::systems::uav) const LARGEST: f64 = 1e6;

/// A line of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// µs.
    pub t_us: i64,
    /// δe, δt.
    pub input: [f64; 2],
    /// What was measured, in the order of the log's outputs; an empty field is nothing.
    pub measured: Vec<Option<f64>>,
}

/// A log.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// Which of the model's outputs the log has.
    pub outputs: Vec<usize>,
    /// In the order of their times.
    pub samples: Vec<Sample>,
    /// The usual time between samples, s.
    pub interval_s: f64,
    /// How many times samples are missing.
    pub gaps: usize,
}

/// Reads what an autopilot logged, or columns `t`, `delta_e`, `delta_t` and those of the model's outputs that there are.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path, names: &[&str], options: &Options) -> Result<(Log, Found), Error> {
    let bytes = text::bytes(path)?;
    let flight = flight::read(&bytes, options).map_err(|error| table::refused(path, &error))?;
    let (outputs, samples, found) = match flight {
        Some(flight) => of_autopilot(path, names, flight)?,
        None => of_table(path, &bytes, names, options)?,
    };
    if samples.iter().flat_map(|sample| &sample.measured).all(Option::is_none) {
        let problem = "expected measurements, found none in any line".to_owned();
        return Err(Error::File { path: path.to_path_buf(), problem });
    }
    let (interval_s, gaps) = regular(path, &samples)?;
    Ok((Log { outputs, samples, interval_s, gaps }, found))
}

/// Which outputs there are, the samples, and how they were read.
type Contents = (Vec<usize>, Vec<Sample>, Found);

/// The model's outputs that are states which an autopilot logs.
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
        &Logged { what: "a recorded flight", usual_step_s: Some(USUAL_STEP_S), options },
        |header| {
            let inputs = header.require(["t", "delta_e", "delta_t"])?;
            let columns = measured_columns(header, names)?;
            if columns.is_empty() {
                return Err(header.error(format!(
                    "expected at least one column of {}, found none",
                    names.join(", ")
                )));
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
        }
    }
    Ok(columns)
}

/// The usual interval, s, and how many are much longer.
fn regular(path: &Path, samples: &[Sample]) -> Result<(f64, usize), Error> {
    let mut steps: Vec<f64> =
        samples.windows(2).map(|pair| (pair[1].t_us - pair[0].t_us) as f64 / 1e6).collect();
    steps.sort_by(f64::total_cmp);
    let wrong = |problem| Error::File { path: path.to_path_buf(), problem };
    let Some(&usual) = steps.get(steps.len() / 2) else {
        return Err(wrong("expected at least two samples".to_owned()));
    };
    let near = steps.iter().filter(|step| (*step / usual - 1.0).abs() <= JITTER).count();
    if (near as f64) < REGULAR * steps.len() as f64 {
        return Err(wrong(format!(
            "expected samples at a regular interval, found {near} of {} near {usual} s",
            steps.len()
        )));
    }
    Ok((usual, steps.iter().filter(|step| **step > GAP * usual).count()))
}

/// True states: a time in µs, and those that the file has of α, q, V, θ.
pub type Truth = Vec<(i64, [Option<f64>; 4])>;

/// Reads columns `t` and some of `alpha`, `q`, `V`, `theta`.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read_truth(path: &Path) -> Result<Truth, Error> {
    let mut truth = Truth::new();
    table::read(
        path,
        "true states",
        |header| {
            let [t] = header.require(["t"])?;
            let columns = measured_columns(header, &STATE_COLUMNS)?;
            if columns.is_empty() {
                return Err(header.error("expected a column alpha, q, V or theta, found none"));
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
