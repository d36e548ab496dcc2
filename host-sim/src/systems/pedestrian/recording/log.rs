//! Recorded walks: a reader of both log formats, which recognises them by itself.
//!
//! | | columns | units |
//! |---|---|---|
//! | CSV | a header naming `t,ax,ay,az,gx,gy,gz` in any order; others are ignored | s, m/s², rad/s |
//! | | and, all three or none, `gt_x,gt_y,gt_z`: the truth | m |
//! | Razor | blank-separated, after one header line or none; columns beyond the 7th are ignored | ms, 3 × g, 3 × °/s |
//!
//! The first line that starts with a number decides: with a comma it is CSV. Times may repeat and
//! may leave gaps, as recorded times do; they may not go backwards.

use std::path::Path;

use super::position::TrackPoint;
use crate::Error;
use crate::metrics::STANDARD_GRAVITY;
use crate::systems::pedestrian::Sample;
use crate::text::{Header, Line, TextFile};

const CSV_COLUMNS: [&str; 7] = ["t", "ax", "ay", "az", "gx", "gy", "gz"];
const TRUTH_COLUMNS: [&str; 3] = ["gt_x", "gt_y", "gt_z"];
const RAZOR_COLUMNS: [&str; 7] = ["time", "accX", "accY", "accZ", "gyrX", "gyrY", "gyrZ"];

/// Beyond what any accelerometer gives, m/s²: 1000 g.
const LARGEST_SPECIFIC_FORCE: f64 = 1000.0 * STANDARD_GRAVITY;
/// Beyond what any gyroscope gives, rad/s: 10⁵ °/s.
const LARGEST_ANGULAR_RATE: f64 = 1e5 * std::f64::consts::PI / 180.0;
/// Beyond any clock, s: three centuries, within which a double resolves microseconds.
const LATEST_TIME: f64 = 1e10;
/// Beyond any place on earth in any projection, m.
const FARTHEST_POSITION: f64 = 1e8;

/// A recorded walk.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Log {
    /// At least one sample; times never decrease.
    pub samples: Vec<Sample>,
    /// Where the sensor was at each sample, if the log says so.
    pub truth: Option<Vec<TrackPoint>>,
    /// What is suspicious but readable.
    pub warnings: Vec<String>,
}

impl Log {
    /// Time of the first sample, µs.
    pub fn start_us(&self) -> u64 {
        self.samples.first().map_or(0, |sample| sample.time_us)
    }

    /// Time of the last sample, µs.
    pub fn end_us(&self) -> u64 {
        self.samples.last().map_or(0, |sample| sample.time_us)
    }

    /// From the first to the last sample, s.
    pub fn duration_s(&self) -> f64 {
        (self.end_us() - self.start_us()) as f64 / 1e6
    }
}

/// Reads a log.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path) -> Result<Log, Error> {
    parse(&TextFile::read(path)?)
}

/// Reads a log from memory.
///
/// # Errors
/// As [`read`].
pub fn parse(file: &TextFile) -> Result<Log, Error> {
    let Some(first) = file.lines().next() else {
        return Err(file.error("expected a log, found an empty file"));
    };
    let data = file.lines().find(Line::starts_with_number);
    let is_csv = data.unwrap_or(first).text.contains(',');
    let mut log = if is_csv { parse_csv(file, first)? } else { parse_razor(file)? };
    if log.samples.is_empty() {
        return Err(file.error("expected samples after the header, found none"));
    }
    if !file.ends_with_line_break() {
        log.warnings.push("the log does not end with a line break: its end may be cut".to_owned());
    }
    Ok(log)
}

fn parse_csv<'a>(file: &'a TextFile, first: Line<'a>) -> Result<Log, Error> {
    if first.starts_with_number() {
        return Err(first.error(
            "expected a header with a column t, or Razor text separated by blanks, found neither",
        ));
    }
    let header = Header::new(first);
    let columns = header.require(CSV_COLUMNS)?;
    let has_truth = TRUTH_COLUMNS.iter().any(|name| header.find(name).is_some());
    let truth_columns = has_truth.then(|| header.require(TRUTH_COLUMNS)).transpose()?;
    let mut log = Log { truth: has_truth.then(Vec::new), ..Log::default() };
    for line in file.lines().skip(1) {
        let fields = header.fields(&line)?;
        let values = numbers(&line, CSV_COLUMNS, columns.map(|column| fields[column]))?;
        push(&mut log, &line, values)?;
        if let (Some(truth), Some(columns)) = (&mut log.truth, truth_columns) {
            let position = numbers(&line, TRUTH_COLUMNS, columns.map(|column| fields[column]))?;
            check(&line, &TRUTH_COLUMNS, &position, FARTHEST_POSITION, "m")?;
            truth.push(TrackPoint { time_us: microseconds(values[0]), position });
        }
    }
    Ok(log)
}

fn parse_razor(file: &TextFile) -> Result<Log, Error> {
    let header_lines =
        usize::from(file.lines().next().is_some_and(|line| !line.starts_with_number()));
    let mut log = Log::default();
    let mut width = None;
    for line in file.lines().skip(header_lines) {
        let fields = line.blank_separated();
        let expected = *width.get_or_insert(fields.len().max(RAZOR_COLUMNS.len()));
        if fields.len() != expected {
            let found = fields.len();
            return Err(
                line.error(format!("expected {expected} blank-separated fields, found {found}"))
            );
        }
        let [t, ax, ay, az, gx, gy, gz] =
            numbers(&line, RAZOR_COLUMNS, std::array::from_fn(|i| fields[i]))?;
        let [ax, ay, az] = [ax, ay, az].map(|force| force * STANDARD_GRAVITY);
        let [gx, gy, gz] = [gx, gy, gz].map(f64::to_radians);
        push(&mut log, &line, [t * 1e-3, ax, ay, az, gx, gy, gz])?;
    }
    Ok(log)
}

fn numbers<const N: usize>(
    line: &Line<'_>,
    names: [&str; N],
    fields: [&str; N],
) -> Result<[f64; N], Error> {
    let mut values = [0.0; N];
    for ((value, name), field) in values.iter_mut().zip(names).zip(fields) {
        *value = line.number(name, field)?;
    }
    Ok(values)
}

/// Appends a sample given in s, m/s² and rad/s, if a sensor can have said it.
fn push(log: &mut Log, line: &Line<'_>, values: [f64; 7]) -> Result<(), Error> {
    let [t, ax, ay, az, gx, gy, gz] = values;
    if !(0.0..=LATEST_TIME).contains(&t) {
        return Err(
            line.error(format!("expected a time between 0 and {LATEST_TIME:e} s, found {t:e}"))
        );
    }
    let time_us = microseconds(t);
    if time_us < log.end_us() {
        return Err(
            line.error("expected a time not before that of the line above, found an earlier one")
        );
    }
    let (specific_force, angular_rate) = ([ax, ay, az], [gx, gy, gz]);
    check(line, &["ax", "ay", "az"], &specific_force, LARGEST_SPECIFIC_FORCE, "m/s² (1000 g)")?;
    check(line, &["gx", "gy", "gz"], &angular_rate, LARGEST_ANGULAR_RATE, "rad/s (100000 °/s)")?;
    log.samples.push(Sample { time_us, specific_force, angular_rate });
    Ok(())
}

fn check(
    line: &Line<'_>,
    names: &[&str],
    values: &[f64],
    largest: f64,
    unit: &str,
) -> Result<(), Error> {
    match names.iter().zip(values).find(|(_, value)| value.abs() > largest) {
        Some((name, value)) => Err(line.error(format!(
            "expected at most {largest:.0} {unit} in column {name}, found {value:e}"
        ))),
        None => Ok(()),
    }
}

/// Seconds, not negative, as the nearest microsecond.
pub(super) fn microseconds(seconds: f64) -> u64 {
    (seconds * 1e6).round() as u64
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these values are exact")]
#[path = "log_tests.rs"]
mod tests;
