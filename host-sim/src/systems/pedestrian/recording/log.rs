//! Logs of walks: text of any device, read by [`kestirim_import`], and the truth that may be given beside the sensor's
//! columns as `gt_x`, `gt_y`, `gt_z` (m; all three or none).

use std::path::Path;

pub use kestirim_import::Options;
use kestirim_import::inertial::{self, Conclusion, Inertial};
use kestirim_replay::pedestrian::TrackPoint;

use crate::Error;
use crate::systems::pedestrian::Sample;
use crate::table::{FARTHEST_POSITION, MOST_NAMED, refused};
use crate::text::{self, listed};

const TRUTH_COLUMNS: [&str; 3] = ["gt_x", "gt_y", "gt_z"];
/// The contents of a log.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Log {
    /// The samples: at least one, with times that never decrease.
    pub samples: Vec<Sample>,
    /// The true position of the sensor at each sample, if the log has it.
    pub truth: Option<Vec<TrackPoint>>,
    /// The magnetic field at each sample (body frame, in the log's unit, NaN where it was not measured), if the log has
    /// one.
    pub field: Option<Vec<[f64; 3]>>,
    /// The conclusions about columns and units, and what they are based on.
    pub import: Vec<String>,
    /// Warnings about readable but suspicious contents.
    pub warnings: Vec<String>,
}

impl Log {
    /// The time of the first sample (µs).
    pub fn start_us(&self) -> u64 {
        self.samples.first().map_or(0, |sample| sample.time_us)
    }

    /// The time of the last sample (µs).
    pub fn end_us(&self) -> u64 {
        self.samples.last().map_or(0, |sample| sample.time_us)
    }

    /// The time from the first to the last sample (s).
    pub fn duration_s(&self) -> f64 {
        (self.end_us() - self.start_us()) as f64 / 1e6
    }
}

/// Reads a log.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read(path: &Path, options: &Options) -> Result<Log, Error> {
    parse(path, &text::unpacked(path)?, options)
}

/// Reads the contents of the file `path`.
///
/// # Errors
/// Those of [`read`].
pub fn parse(path: &Path, bytes: &[u8], options: &Options) -> Result<Log, Error> {
    let read = inertial::read(bytes, options).map_err(|error| refused(path, &error))?;
    let truth = truth(path, &read)?;
    let import = read.conclusions.iter().map(Conclusion::to_string);
    Ok(Log {
        truth,
        field: read.magnetic_field(),
        import: import.chain(left_out(&read)).collect(),
        warnings: read.damage.sentences(),
        samples: read.samples,
    })
}

/// A sentence that lists unused numeric columns, if there are any.
fn left_out(log: &Inertial) -> Option<String> {
    let field = log.magnetic_columns().unwrap_or_default();
    let names = log.other.iter().map(|(name, _)| name.as_str());
    let names = names.filter(|name| !field.contains(name) && !TRUTH_COLUMNS.contains(name));
    let names = listed(names, MOST_NAMED);
    (!names.is_empty()).then(|| format!("columns that are not used: {names}"))
}

/// The true positions of the sensor, if the log has columns for them.
fn truth(path: &Path, log: &Inertial) -> Result<Option<Vec<TrackPoint>>, Error> {
    let columns = TRUTH_COLUMNS.map(|name| log.column(name));
    if columns.iter().all(Option::is_none) {
        return Ok(None);
    }
    let error = |line, problem| Err(Error::Line { path: path.to_path_buf(), line, problem });
    if let Some(missing) = columns.iter().position(Option::is_none) {
        let name = TRUTH_COLUMNS[missing];
        return error(1, format!("expected a header with a column {name}, found none"));
    }
    let mut truth = Vec::with_capacity(log.samples.len());
    for (place, sample) in log.samples.iter().enumerate() {
        let position = columns.map(|column| column.map_or(f64::NAN, |column| column[place]));
        let is_known = |metres: &f64| metres.abs() <= FARTHEST_POSITION;
        if let Some(wrong) = position.iter().position(|metres| !is_known(metres)) {
            let (name, found) = (TRUTH_COLUMNS[wrong], position[wrong]);
            let problem = format!("expected a position in metres in column {name}, found {found}");
            return error(log.rows[place], problem);
        }
        truth.push(TrackPoint { time_us: sample.time_us, position });
    }
    Ok(Some(truth))
}

#[cfg(test)]
#[path = "log_tests.rs"]
mod tests;
