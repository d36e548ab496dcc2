//! Logs of an inertial sensor: time, three axes of an accelerometer, three of a gyroscope.
//!
//! # What the data tell
//!
//! - **The accelerometer's unit**: at rest it shows 1 g.
//! - **The gyroscope's unit, and that of time where its spacing leaves a choice**: between two moments of rest the turn
//!   that it measured must carry the direction of gravity along, and the turned specific force must be gravity's reaction
//!   in the mean. One unit must fit far better than all others. There is no threshold of plausible rates.
//! - **Swapped or mirrored axes** of the gyroscope against the accelerometer: the same test over all 48 ways.
//!
//! # What the data cannot tell
//!
//! **The sign of the accelerometer.** Some sensors show −1 g upwards at rest. Let `R` be the turn from the body to a
//! frame with z up, `f` the specific force and `g` gravity, so that the acceleration is `a = R f − g z`. A log whose
//! accelerometer has the other sign holds `f' = −f` with the same rates. An alignment takes the opposite direction for
//! up: `R' = H R`, where `H` is half a turn about a horizontal axis, `H z = −z`. The rates carry `R'` along as they
//! carry `R`. Then
//!
//! ```text
//! a' = R' f' − g z = −H R f − g z = −H (a + g z) − g z = −H a + g z − g z = −H a
//! ```
//!
//! and `−H` is a reflection in a vertical plane: for `H = diag(1, −1, −1)` it is `diag(−1, 1, 1)`. So all positions are
//! mirrored, heights and lengths are the same, nothing in the log contradicts this, and a foot rises in each stride
//! either way. A sensor may also be mounted upside down, so a negative z proves nothing. Specific force, +1 g upwards
//! at rest, is taken unless a format or an option (`acc=-g`) says otherwise.
//!
//! **A rotation of all axes together**, that is, the mounting of the sensor, is not an error: it changes nothing.

mod by_name;
mod columns;
mod conclusion;
mod evidence;
mod found;
mod motion;
mod order;
mod packets;
mod raw;
mod rest;
mod rows;
mod stands;
mod turns;
mod units;

pub use conclusion::{Conclusion, Source};
pub use stands::{Stand, stands};
pub use turns::{Turns, turns};

use columns::Columns;
use found::Found;
use order::Rows;
use units::Units;

use crate::containers::{self, Opened};
use crate::counter::PERIODS;
use crate::damage::{Damage, Fault};
use crate::error::Error;
use crate::layout::Kind;
use crate::options::{Options, ROLES};
use crate::table::Table;
use crate::unit::STANDARD_GRAVITY;

/// The largest plausible specific force, m/s²: 1000 g, beyond any accelerometer.
const LARGEST_SPECIFIC_FORCE: f64 = 1000.0 * STANDARD_GRAVITY;
/// The largest plausible angular rate, rad/s: 10⁵ °/s, beyond any gyroscope.
const LARGEST_ANGULAR_RATE: f64 = 1e5 * std::f64::consts::PI / 180.0;
/// The latest plausible time, s: three centuries, beyond any clock; up to there a double resolves microseconds.
const LATEST_TIME: f64 = 1e10;

/// The names of a magnetometer's columns. Any unit will do: only directions and ratios are used.
const FIELD_COLUMNS: [[&str; 3]; 5] = [
    ["mx_G", "my_G", "mz_G"],
    ["mx_uT", "my_uT", "mz_uT"],
    ["mx", "my", "mz"],
    ["magx", "magy", "magz"],
    ["mag_x", "mag_y", "mag_z"],
];

/// One sample of an inertial sensor, in its own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time on the log's own clock, µs.
    pub time_us: u64,
    /// Specific force, m/s²: +1 g upwards at rest.
    pub specific_force: [f64; 3],
    /// Angular rate, rad/s, right-handed.
    pub angular_rate: [f64; 3],
}

/// A log of an inertial sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Inertial {
    /// At least one sample; times never decrease.
    pub samples: Vec<Sample>,
    /// The line of each sample, or its record in a binary file; in a zip of texts, its line in the gyroscope's text.
    pub rows: Vec<usize>,
    /// The offset that was subtracted from the log's times, s: 0 unless they begin below zero or beyond 10¹⁰ s.
    pub start: f64,
    /// The other numeric columns, by name: one value for each sample, NaN where it is missing.
    pub other: Vec<(String, Vec<f64>)>,
    /// What was concluded about the log, and on what evidence.
    pub conclusions: Vec<Conclusion>,
    /// What was skipped.
    pub damage: Damage,
}

impl Inertial {
    /// The values of another column, if there is one of this name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let found = self.other.iter().find(|(known, _)| known == name);
        found.map(|(_, values)| values.as_slice())
    }

    /// The names of the magnetometer's columns, if the log has columns of a usual name.
    pub fn magnetic_columns(&self) -> Option<[&'static str; 3]> {
        let is_there = |name: &&str| self.column(name).is_some();
        FIELD_COLUMNS.into_iter().find(|names| names.iter().all(is_there))
    }

    /// The magnetic field at each sample (body frame, in the log's unit, NaN where it was not measured), if there are
    /// [columns](Self::magnetic_columns) of it.
    pub fn magnetic_field(&self) -> Option<Vec<[f64; 3]>> {
        let [x, y, z] = self.magnetic_columns()?.map(|name| self.column(name));
        let (x, y, z) = (x?, y?, z?);
        Some(x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z]).collect())
    }
}

/// Reads a log.
///
/// # Errors
/// What was expected and what was found, and which option decides where the log does not tell.
pub fn read(bytes: &[u8], options: &Options) -> Result<Inertial, Error> {
    options.refuse_others()?;
    let Opened { mut table, text, format, notes } = containers::open(bytes, options)?;
    let mut damage = std::mem::take(&mut table.damage);
    let total = table.lines.len() + damage.count();
    damage.accept(total, options.strict)?;
    // A known format determines the columns.
    if format.is_none_or(|format| format.description().is_a_guess) {
        refuse_other_header(&table)?;
    }
    let columns = Columns::find(&table, format, options)?;
    let mut rows = Rows::of(text.as_ref(), &table, &columns, &mut damage);
    damage.accept(total, options.strict)?;
    rows.put_in_order(periods(&table, &columns), &mut damage)?;
    let doubles = if options.strict { 0 } else { rows.without_doubles(&mut damage) };
    damage.accept(total, options.strict)?;
    packets::refuse_shared_times(&rows.raw)?;
    let units = units::decide(&rows.raw, &columns.claims, columns.axes_are_said)?;
    let (samples, start) = samples(&mut rows, &columns, &units, &mut damage);
    damage.accept(total, options.strict)?;
    let found = Found { table: &table, columns: &columns, units: &units, doubles, start };
    let conclusions = found.conclusions(format, &notes);
    let other = other(table, &columns, &rows.places);
    Ok(Inertial { samples, rows: rows.lines, start, other, conclusions, damage })
}

/// Refuses a table whose line above the rows names most of the columns, but not exactly as many as there are: which
/// name belongs to which column is then undecided.
fn refuse_other_header(table: &Table) -> Result<(), Error> {
    let Some((line, words)) = &table.other_header else { return Ok(()) };
    let named = words.iter().filter(|word| crate::names::meaning(word).is_some()).count();
    if named + 1 < ROLES.len() {
        return Ok(());
    }
    let (names, fields) = (words.len(), table.columns.len());
    Err(Error::line(
        *line,
        format!("expected as many names as fields below, found {names} and {fields}"),
    ))
}

/// What the clock may begin anew at, in its own unit.
fn periods(table: &Table, columns: &Columns) -> &'static [f64] {
    match columns.time.map(|time| table.columns[time].kind) {
        Some(Kind::TimeOfDay) => &[86_400e6],
        Some(Kind::Number) => &PERIODS,
        _ => &[],
    }
}

/// The samples in SI units, without values that no sensor can measure; and the offset that was subtracted from their
/// times, s.
fn samples(
    rows: &mut Rows,
    columns: &Columns,
    units: &Units,
    damage: &mut Damage,
) -> (Vec<Sample>, f64) {
    let [force, rate, time] = &units.units;
    let first = rows.raw.first().map_or(0.0, |raw| raw.time);
    let last = rows.raw.last().map_or(0.0, |raw| raw.time);
    let is_clock = columns.time.is_some() && first >= 0.0 && last * time.scale <= LATEST_TIME;
    let start = if is_clock { 0.0 } else { first };
    let microseconds =
        |time_in_unit: f64| ((time_in_unit - start) * (time.scale * 1e6)).round() as u64;
    let mut samples = Vec::with_capacity(rows.raw.len());
    let mut is_left = Vec::new();
    for (i, raw) in rows.raw.iter().enumerate() {
        let specific_force = raw.force.map(|x| x * force.scale);
        let angular_rate = raw.rate.map(|x| x * rate.scale);
        let beyond = beyond(&specific_force, &angular_rate);
        if let Some(problem) = beyond {
            damage.add(Fault::OutOfRange, rows.lines[i], || problem);
            is_left.push(i);
        } else {
            samples.push(Sample { time_us: microseconds(raw.time), specific_force, angular_rate });
        }
    }
    rows.remove(&is_left);
    (samples, start * time.scale)
}

/// Describes values that no sensor can measure, if there are any.
fn beyond(specific_force: &[f64; 3], angular_rate: &[f64; 3]) -> Option<String> {
    let values = [
        (&ROLES[1..4], specific_force, LARGEST_SPECIFIC_FORCE, "m/s² (1000 g)"),
        (&ROLES[4..7], angular_rate, LARGEST_ANGULAR_RATE, "rad/s (100000 °/s)"),
    ];
    values.into_iter().find_map(|(names, values, largest, unit)| {
        let axis = (0..3).find(|&axis| values[axis].abs() > largest)?;
        let (name, value) = (names[axis], values[axis]);
        Some(format!("expected at most {largest:.0} {unit} in column {name}, found {value:e}"))
    })
}

/// The numeric columns that are neither time nor the sensor's axes.
fn other(table: Table, columns: &Columns, places: &[usize]) -> Vec<(String, Vec<f64>)> {
    let used = |at: usize| {
        columns.time == Some(at) || columns.sensors.iter().any(|axis| axis.column == at)
    };
    let all = table.columns.into_iter().enumerate();
    let others = all.filter(|(at, column)| !used(*at) && column.kind != Kind::Words);
    others
        .map(|(_, column)| {
            let whole = places.len() == column.values.len();
            let values = if whole {
                column.values
            } else {
                places.iter().map(|&i| column.values[i]).collect()
            };
            (column.name, values)
        })
        .collect()
}
