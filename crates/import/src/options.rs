//! The user's statements about a log, which overrule everything that is inferred.

use std::str::FromStr;

use crate::error::{Error, quoted};
use crate::formats::Format;
use crate::heading;
use crate::unit::{Quantity, Unit};

/// The user's statements about a log.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// The columns that are time, accelerometer and gyroscope.
    pub columns: Columns,
    /// The units of the columns.
    pub units: Units,
    /// The program or device that wrote the log.
    pub format: Option<Format>,
    /// The sensor to read of several in one file: the name of a topic in a ROS bag or MCAP file, the number of an
    /// `ArduPilot` or PX4 sensor.
    pub topic: Option<String>,
    /// Whether the first damaged line causes the log to be refused, instead of being skipped.
    pub strict: bool,
}

impl Options {
    /// Refuses statements about columns that the log of an inertial sensor does not have.
    pub(crate) fn refuse_others(&self) -> Result<(), Error> {
        let columns = self.columns.others.iter().map(|(name, _)| *name);
        let mut others = columns.chain(self.units.others.iter().map(|(name, _)| *name));
        others.next().map_or(Ok(()), |name| {
            let roles = ROLES.join(", ");
            Err(Error::options(format!("expected options of {roles} alone, found one of {name}")))
        })
    }
}

impl Options {
    /// Refuses statements about columns other than these, and about the log's format.
    pub(crate) fn refuse_beside(&self, names: &[&str]) -> Result<(), Error> {
        let roles = ROLES.iter().zip(&self.columns.picks).filter(|(_, pick)| pick.is_some());
        let columns = roles.map(|(role, _)| *role);
        let columns = columns.chain(self.columns.others.iter().map(|(name, _)| *name));
        let Units { acceleration, rate, time, others } = &self.units;
        let units =
            [("acc", acceleration.is_some()), ("gyro", rate.is_some()), ("t", time.is_some())];
        let units = units.into_iter().filter_map(|(name, is_said)| is_said.then_some(name));
        let units = units.chain(others.iter().map(|(name, _)| *name));
        let mut said = columns.chain(units);
        said.find(|name| !names.contains(name)).map_or(Ok(()), |name| {
            let names = names.join(", ");
            Err(Error::options(format!("expected options of {names} alone, found one of {name}")))
        })
    }
}

/// The names of the columns that an inertial log must hold.
pub(crate) const ROLES: [&str; 7] = ["t", "ax", "ay", "az", "gx", "gy", "gz"];

/// The columns of time, accelerometer and gyroscope: `t=timestamp,ax=AccX,gy=-GyrZ`. A minus sign reverses an axis.
/// Without a header columns are named by their number, from 1. In other logs: `anchor=node,range=dist`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Columns {
    /// The choices in the order t, ax, ay, az, gx, gy, gz.
    pub(crate) picks: [Option<Pick>; 7],
    /// The choices for logs of other sensors.
    others: Vec<(&'static str, Pick)>,
}

impl Columns {
    /// The column that was chosen for this name.
    pub(crate) fn of(&self, name: &str) -> Option<&Pick> {
        match ROLES.iter().position(|&role| role == name) {
            Some(place) => self.picks[place].as_ref(),
            None => self.others.iter().find(|(known, _)| *known == name).map(|(_, pick)| pick),
        }
    }
}

/// A column, possibly with its sign reversed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Pick {
    pub(crate) name: String,
    pub(crate) is_negative: bool,
}

impl FromStr for Columns {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let mut columns = Self::default();
        for (role, name) in pairs(text, "t=timestamp,ax=AccX")? {
            let (name, is_negative) =
                name.strip_prefix('-').map_or((name, false), |name| (name, true));
            let pick = Pick { name: name.to_owned(), is_negative };
            let place = ROLES.iter().position(|&known| known == role);
            match (place, heading::names().find(|(known, _)| *known == role)) {
                (Some(place), _) => columns.picks[place] = Some(pick),
                (None, Some((name, _))) => columns.others.push((name, pick)),
                (None, None) => {
                    let others = heading::names().map(|(name, _)| name);
                    let names: Vec<_> = ROLES.into_iter().chain(others).collect();
                    let (names, found) = (names.join(", "), quoted(role));
                    return Err(Error::options(format!("expected one of {names}, found {found}")));
                }
            }
        }
        Ok(columns)
    }
}

/// The units of a log: `acc=g,gyro=deg/s,t=ms`.
///
/// A factor may precede a unit (`gyro=0.07deg/s`), and a minus sign that of an accelerometer that shows −1 g upwards at
/// rest (`acc=-g`). Counts are given by how many make one g or one °/s (`acc=16384lsb,gyro=131lsb`), and samples that
/// are only numbered by their rate (`t=100Hz`).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Units {
    /// The unit of the accelerometer.
    pub acceleration: Option<Unit>,
    /// The unit of the gyroscope.
    pub rate: Option<Unit>,
    /// The unit of time, or the sampling rate.
    pub time: Option<TimeUnit>,
    /// The units of the columns of other sensors.
    others: Vec<(&'static str, Unit)>,
}

impl Units {
    /// The unit that was stated for the column of this name.
    pub(crate) fn of(&self, name: &str) -> Option<Unit> {
        match (ROLES.iter().position(|&role| role == name), &self.time) {
            (Some(0), Some(TimeUnit::Clock(unit))) => Some(unit.clone()),
            (Some(1..=3), _) => self.acceleration.clone(),
            (Some(4..=6), _) => self.rate.clone(),
            (Some(_), _) => None,
            (None, _) => {
                self.others.iter().find(|(known, _)| *known == name).map(|(_, unit)| unit.clone())
            }
        }
    }
}

/// How time is given.
#[derive(Debug, Clone, PartialEq)]
pub enum TimeUnit {
    /// A clock that counts in this unit.
    Clock(Unit),
    /// A counter of samples at this rate, Hz.
    Rate(f64),
}

impl FromStr for Units {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let mut units = Self::default();
        for (quantity, unit) in pairs(text, "acc=g,gyro=deg/s,t=ms")? {
            let wrong = |expected: &str| {
                Error::options(format!("expected {expected}, found {}", quoted(unit)))
            };
            match quantity {
                "acc" | "a" | "acceleration" => {
                    let read = Unit::read_scaled(Quantity::Acceleration, unit);
                    let read =
                        read.ok_or_else(|| wrong("a unit such as m/s2, g, mg or 16384lsb"))?;
                    units.acceleration = Some(read);
                }
                "gyro" | "gyr" | "g" | "rate" => {
                    let read = Unit::read_scaled(Quantity::Rate, unit);
                    let read =
                        read.ok_or_else(|| wrong("a unit such as rad/s, deg/s or 131lsb"))?;
                    units.rate = Some(read);
                }
                "t" | "time" => {
                    let expected = "a unit such as s, ms, us or ns, or a rate such as 100Hz";
                    units.time = Some(time_unit(unit).ok_or_else(|| wrong(expected))?);
                }
                other => {
                    let known = heading::names().find(|(name, _)| *name == other);
                    let Some((name, Some(measured))) = known else {
                        let expected =
                            "expected acc, gyro, t or the name of a column such as range";
                        let found = quoted(other);
                        return Err(Error::options(format!("{expected}, found {found}")));
                    };
                    let read = Unit::read_scaled(measured, unit);
                    units.others.push((name, read.ok_or_else(|| wrong("a unit such as cm"))?));
                }
            }
        }
        Ok(units)
    }
}

fn time_unit(text: &str) -> Option<TimeUnit> {
    let lower = text.to_lowercase();
    if let Some(rate) = lower.strip_suffix("hz") {
        let rate: f64 = rate.trim().parse().ok()?;
        return (rate.is_normal() && rate > 0.0).then_some(TimeUnit::Rate(rate));
    }
    let unit = Unit::read_scaled(Quantity::Time, text)?;
    (unit.scale > 0.0).then_some(TimeUnit::Clock(unit))
}

/// Splits `a=b,c=d` into pairs.
fn pairs<'a>(text: &'a str, example: &str) -> Result<Vec<(&'a str, &'a str)>, Error> {
    let wrong = |part: &str| {
        Error::options(format!("expected pairs such as {example}, found {}", quoted(part)))
    };
    let pair = |part: &'a str| {
        let (name, value) = part.split_once('=').ok_or_else(|| wrong(part))?;
        let (name, value) = (name.trim(), value.trim());
        if name.is_empty() || value.is_empty() { Err(wrong(part)) } else { Ok((name, value)) }
    };
    text.split(',').map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read() {
        let columns: Columns = "t=timestamp, gy=-Gyr Z".parse().unwrap();
        assert_eq!(columns.picks[0].as_ref().unwrap().name, "timestamp");
        let pick = columns.picks[5].as_ref().unwrap();
        assert_eq!((pick.name.as_str(), pick.is_negative), ("Gyr Z", true));
        for (text, expected) in [
            ("mx=y", "expected one of t, ax, ay, az, gx, gy, gz, anchor, range, anchor_a, "),
            ("t", "expected pairs such as t=timestamp,ax=AccX, found \"t\""),
            ("t=", "found \"t=\""),
            ("", "found nothing"),
        ] {
            let error = text.parse::<Columns>().unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn units_are_read() {
        let units: Units = "acc=-g,gyro=131lsb,t=100Hz".parse().unwrap();
        assert_eq!(units.acceleration.unwrap().name, "−g");
        assert_eq!(units.rate.unwrap().name, "counts of 1/131 °/s");
        assert_eq!(units.time, Some(TimeUnit::Rate(100.0)));
        assert!("t=ms".parse::<Units>().is_ok());
        for text in ["acc=ms", "t=-s", "t=0Hz", "gyro=g", "mag=uT", "t=infHz"] {
            assert!(text.parse::<Units>().is_err(), "{text}");
        }
    }
}
