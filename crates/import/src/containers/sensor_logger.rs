//! Zip files of CSV that Sensor Logger exports (Kelvin Choi, <https://github.com/tszheichoi/awesome-sensor-logger>).
//!
//! Each sensor is a file with columns `time` (ns since 1970), `seconds_elapsed`, `z`, `y`, `x`. `TotalAcceleration.csv`
//! holds the accelerometer; `Accelerometer.csv` excludes gravity, which `Gravity.csv` holds;
//! `AccelerometerUncalibrated.csv` is the accelerometer as the system gives it (`UNITS.md` there). All are in m/s²,
//! except that the last one is in g on iOS.
//!
//! On iOS all three have the opposite sign (`COORDINATES.md`), and so has gravity, unless "Standardise Units & Frames"
//! was on. `Metadata.csv` tells both in its columns `platform` and `standardisation`; without it +1 g upwards at rest
//! is assumed and reported. An option for the accelerometer's unit leaves its values as they are.

use super::Decoded;
use super::gather::Stream;
use super::join::join;
use super::member;
use super::zipped::Zipped;
use crate::damage::Damage;
use crate::dialect::{Dialect, Separator};
use crate::error::Error;
use crate::formats::{Description, Format};
use crate::options::Options;
use crate::text::{Text, letters};
use crate::unit::{Quantity, STANDARD_GRAVITY};

pub(crate) const SENSOR_LOGGER: Description = Description {
    format: Format::SensorLogger,
    name: "sensor-logger",
    title: "Sensor Logger",
    is_it: None,
    time: &[(TIME, "ns")],
    sensors: [
        "Acceleration x",
        "Acceleration y",
        "Acceleration z",
        "Gyroscope x",
        "Gyroscope y",
        "Gyroscope z",
    ],
    acceleration: "m/s2",
    rate: "rad/s",
    is_a_guess: false,
};

const TIME: &str = "time";
/// One second in the unit of times.
const SECOND: f64 = 1e9;
/// A column that the header of each text contains.
pub(super) const ELAPSED: &str = "seconds_elapsed";

const TOTAL: &str = "TotalAcceleration.csv";
const LINEAR: &str = "Accelerometer.csv";
const GRAVITY: &str = "Gravity.csv";
const UNCALIBRATED: &str = "AccelerometerUncalibrated.csv";
const METADATA: &str = "Metadata.csv";

/// Reads the accelerometer in addition to the gyroscope's text.
///
/// # Errors
/// If an accelerometer with gravity is missing, or a text is not of the format.
pub(super) fn read(
    zipped: &mut Zipped<'_>,
    gyroscope: &[u8],
    file: &'static str,
    options: &Options,
) -> Result<Decoded, Error> {
    let (rates, rate_damage) = member::read(gyroscope, file, TIME, Quantity::Rate)?;
    let phone = Phone::read(zipped)?;
    let source = Source::of(zipped)?;
    let mut accelerometer = |file: &'static str| {
        let text = zipped.unpack(file)?;
        member::read(&text, file, TIME, Quantity::Acceleration)
    };
    let (mut forces, force_damage, from) = match source {
        Source::Of(file) => {
            let (forces, damage) = accelerometer(file)?;
            (forces, damage, file.to_owned())
        }
        Source::Sum => {
            let ((linear, damage), (gravity, other)) =
                (accelerometer(LINEAR)?, accelerometer(GRAVITY)?);
            let damage = Damage::joined([damage, other]);
            (sum(linear, &gravity)?, damage, format!("{LINEAR} + {GRAVITY}"))
        }
    };
    let mut notes = vec![format!("acceleration from {from}")];
    if options.units.acceleration.is_none() {
        notes.extend(phone.put_right(&mut forces, from == UNCALIBRATED)?);
    }
    let (joined, note) = join(&rates, &forces, SECOND)?;
    notes.push(note);
    let damage = Damage::joined([rate_damage, force_damage]);
    Ok(Decoded { table: joined.named(&SENSOR_LOGGER, TIME, damage), notes })
}

/// The source of the accelerometer with gravity.
enum Source {
    Of(&'static str),
    /// The sum of an acceleration without gravity and of gravity.
    Sum,
}

impl Source {
    fn of(zipped: &Zipped<'_>) -> Result<Self, Error> {
        let has = |name| zipped.has(name);
        if has(TOTAL) {
            Ok(Self::Of(TOTAL))
        } else if has(LINEAR) && has(GRAVITY) {
            Ok(Self::Sum)
        } else if has(UNCALIBRATED) {
            Ok(Self::Of(UNCALIBRATED))
        } else {
            let found = zipped.listed();
            Err(Error::log(format!(
                "expected {TOTAL}, or {GRAVITY} beside {LINEAR}, which is without gravity, found {found}"
            )))
        }
    }
}

/// Adds gravity to an acceleration without it, at the times of the latter.
fn sum(linear: Stream, gravity: &Stream) -> Result<Stream, Error> {
    // The columns of the gyroscope carry the acceleration that gravity is added to.
    let [time, ax, ay, az, ..] = linear.columns;
    let none = vec![0.0; time.len()];
    let columns = [time, none.clone(), none.clone(), none, ax, ay, az];
    let (joined, _) = join(&Stream { columns, records: linear.records }, gravity, SECOND)?;
    let mut sum = Stream::default();
    for (i, &record) in joined.records.iter().enumerate() {
        let [time, gx, gy, gz, ax, ay, az] = joined.row(i);
        sum.push(record, [time, ax + gx, ay + gy, az + gz, 0.0, 0.0, 0.0]);
    }
    Ok(sum)
}

/// The properties of the telephone, as far as `Metadata.csv` tells.
struct Phone {
    is_ios: Option<bool>,
    /// Whether units and signs follow Android's on all systems.
    is_standard: bool,
}

impl Phone {
    fn read(zipped: &mut Zipped<'_>) -> Result<Self, Error> {
        if !zipped.has(METADATA) {
            return Ok(Self { is_ios: None, is_standard: false });
        }
        let bytes = zipped.unpack(METADATA)?;
        let text = Text::new(&bytes)?;
        let dialect = Dialect::new(Separator::Comma, false);
        let mut lines = text.lines().map(|line| dialect.fields(line.bytes));
        let (names, values) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
        let value = |name: &[u8]| {
            let place = names.iter().position(|known| **known == *name)?;
            values.get(place).map(|value| letters(value).to_lowercase())
        };
        let is_ios = value(b"platform").and_then(|platform| match platform.as_str() {
            "ios" => Some(true),
            "android" => Some(false),
            _ => None,
        });
        Ok(Self { is_ios, is_standard: value(b"standardisation").as_deref() == Some("true") })
    }

    /// Converts an accelerometer to m/s² and +1 g upwards at rest; returns a note to report.
    fn put_right(&self, forces: &mut Stream, is_raw: bool) -> Result<Option<String>, Error> {
        let (scale, note) = match self.is_ios {
            _ if self.is_standard => return Ok(None),
            Some(false) => return Ok(None),
            Some(true) if is_raw => (-STANDARD_GRAVITY, "acceleration of iOS, from −g"),
            Some(true) => (-1.0, "acceleration of iOS, its sign turned"),
            None if is_raw => {
                let problem = format!(
                    "expected {METADATA}, which tells the unit of {UNCALIBRATED}, found none"
                );
                return Err(Error::undecided(
                    problem,
                    "--units acc=m/s2 (Android) or acc=-g (iOS)",
                ));
            }
            None => (1.0, "sign of the acceleration as of Android, for want of Metadata.csv"),
        };
        for force in forces.columns[1..4].iter_mut().flatten() {
            *force *= scale;
        }
        Ok(Some(note.to_owned()))
    }
}
