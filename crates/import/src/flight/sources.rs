//! The fields of an autopilot's messages that hold the quantities of a flight.

use std::fmt;

use super::order;
use crate::error::{Error, quoted};
use crate::options::Options;
use crate::unit::{Quantity, Unit};

/// The quantities of a flight, by the names of their columns.
pub(crate) const NAMES: [&str; 6] = ["alpha", "q", "V", "theta", "delta_e", "delta_t"];

/// The autopilot program that wrote a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Family {
    ArduPilot,
    Px4,
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ArduPilot => "ArduPilot",
            Self::Px4 => "PX4 ULog",
        })
    }
}

/// A field that is known to hold a quantity.
struct Known {
    quantity: usize,
    field: &'static str,
    /// The symbol of its unit; empty if the log does not tell it.
    unit: &'static str,
    /// A remark on the field that is reported to the user.
    note: Option<&'static str>,
}

const fn known(quantity: usize, field: &'static str, unit: &'static str) -> Known {
    Known { quantity, field, unit, note: None }
}

const ARDUPILOT: [Known; 6] = [
    Known {
        note: Some("alpha is reckoned by the autopilot from airspeed and wind, not measured"),
        ..known(0, "AOA.AOA", "deg")
    },
    known(1, "IMU.GyrY", "rad/s"),
    Known { note: Some("V is calibrated, not true airspeed"), ..known(2, "ARSP.Airspeed", "m/s") },
    known(3, "ATT.Pitch", "deg"),
    known(4, "AETR.Elev", ""),
    known(5, "AETR.Thr", "%"),
];

const PX4: [Known; 9] = [
    known(1, "vehicle_angular_velocity.xyz[1]", "rad/s"),
    known(1, "sensor_combined.gyro_rad[1]", "rad/s"),
    known(2, "airspeed_validated.true_airspeed_m_s", "m/s"),
    known(2, "airspeed.true_airspeed_m_s", "m/s"),
    known(3, "vehicle_attitude.q", "rad"),
    known(4, "vehicle_torque_setpoint.xyz[1]", ""),
    known(4, "actuator_controls_0.control[1]", ""),
    known(5, "vehicle_thrust_setpoint.xyz[0]", "1"),
    known(5, "actuator_controls_0.control[3]", "1"),
];

impl Family {
    fn known(self) -> &'static [Known] {
        match self {
            Self::ArduPilot => &ARDUPILOT,
            Self::Px4 => &PX4,
        }
    }

    /// The field that usually holds a quantity; empty if there is none.
    pub(crate) fn usual(self, quantity: usize) -> &'static str {
        let mut known = self.known().iter();
        known.find(|known| known.quantity == quantity).map_or("", |known| known.field)
    }

    /// The range of elevator commands, and the value of the option that gives the deflection they stand for.
    fn travel(self) -> (&'static str, &'static str) {
        match self {
            Self::ArduPilot => ("-4500 to 4500", "-0.0056deg"),
            Self::Px4 => ("-1 to 1", "-25deg"),
        }
    }
}

/// A field of a message that holds a quantity.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Source {
    /// The index in [`NAMES`].
    pub(crate) quantity: usize,
    pub(crate) message: String,
    pub(crate) field: String,
    /// The index among several numbers of this name.
    pub(crate) index: usize,
    /// Whether the field holds a quaternion, from which the pitch is computed.
    pub(crate) is_quaternion: bool,
    pub(crate) note: Option<&'static str>,
    unit: Option<Unit>,
    is_negative: bool,
}

impl Source {
    fn new(quantity: usize, text: &str) -> Option<Self> {
        let (message, field) = text.split_once('.')?;
        let (field, index) = match field.split_once('[') {
            Some((field, index)) => (field, index.strip_suffix(']')?.parse().ok()?),
            None => (field, 0),
        };
        let (message, field) = (message.trim().to_owned(), field.trim().to_owned());
        let is_quaternion = text == "vehicle_attitude.q";
        let (note, unit, is_negative) = (None, None, false);
        Some(Self { quantity, message, field, index, is_quaternion, note, unit, is_negative })
    }

    /// The name of the field as an option would give it.
    fn name(&self) -> String {
        let index = if self.index > 0 { format!("[{}]", self.index) } else { String::new() };
        format!("{}.{}{index}", self.message, self.field)
    }
}

fn quantity_of(quantity: usize) -> Quantity {
    [
        Quantity::Inclination,
        Quantity::Rate,
        Quantity::Speed,
        Quantity::Inclination,
        Quantity::Inclination,
        Quantity::Share,
    ][quantity]
}

/// The fields to look for, in order of preference.
///
/// # Errors
/// If an option names a field in the wrong form.
pub(super) fn wanted(family: Family, options: &Options) -> Result<Vec<Source>, Error> {
    let mut sources = Vec::new();
    for (quantity, name) in NAMES.iter().enumerate() {
        if let Some(pick) = options.columns.of(name) {
            let source = Source::new(quantity, &pick.name).ok_or_else(|| {
                let example = family.usual(4);
                let found = quoted(&pick.name);
                Error::options(format!("expected --columns {name}={example}, found {found}"))
            })?;
            sources.push(Source { is_negative: pick.is_negative, ..source });
            continue;
        }
        for known in family.known().iter().filter(|known| known.quantity == quantity) {
            let source = Source::new(quantity, known.field);
            let unit = Unit::read(quantity_of(quantity), known.unit);
            sources.extend(source.map(|source| Source { unit, note: known.note, ..source }));
        }
    }
    Ok(sources)
}

/// The values of one field over time.
#[derive(Debug)]
pub(crate) struct Channel {
    pub(crate) source: Source,
    /// The times of the values, µs.
    pub(crate) times: Vec<f64>,
    pub(crate) values: Vec<f64>,
    /// The number of the record that each value is from.
    pub(crate) records: Vec<usize>,
}

impl Channel {
    pub(crate) fn new(source: Source) -> Self {
        Self { source, times: Vec::new(), values: Vec::new(), records: Vec::new() }
    }

    pub(crate) fn push(&mut self, time: f64, value: f64, record: usize) {
        self.times.push(time);
        self.values.push(value);
        self.records.push(record);
    }

    /// Converts the values to SI units and returns a sentence to report.
    ///
    /// # Errors
    /// [`Error::Undecided`] if neither the log nor an option tells the unit.
    pub(super) fn in_si(&mut self, options: &Options) -> Result<String, Error> {
        let (source, name) = (&self.source, NAMES[self.source.quantity]);
        let unit = options.units.of(name).or_else(|| source.unit.clone());
        let unit = unit.ok_or_else(|| source.without_unit(name))?;
        let scale = if source.is_negative { -unit.scale } else { unit.scale };
        if scale != 1.0 {
            self.values.iter_mut().for_each(|value| *value *= scale);
        }
        let sign = if source.is_negative { "-" } else { "" };
        Ok(format!("{name} = {sign}{} in {unit}", source.name()))
    }

    /// Drops the fewest samples that keep the times from increasing strictly; returns their records.
    pub(super) fn put_in_order(&mut self) -> Vec<usize> {
        let kept = order::growing(&self.times);
        if kept.len() == self.times.len() {
            return Vec::new();
        }
        let mut left_out = Vec::new();
        let mut next = kept.iter().copied().peekable();
        for (place, &record) in self.records.iter().enumerate() {
            if next.next_if_eq(&place).is_none() {
                left_out.push(record);
            }
        }
        let pick = |values: &[f64]| kept.iter().map(|&place| values[place]).collect();
        (self.times, self.values) = (pick(&self.times), pick(&self.values));
        self.records = kept.iter().map(|&place| self.records[place]).collect();
        left_out
    }
}

impl Source {
    fn without_unit(&self, name: &str) -> Error {
        let is_travel = |known: &Known| known.quantity == 4 && known.field == self.name();
        let mut families = [Family::ArduPilot, Family::Px4].into_iter();
        let family = families.find(|family| family.known().iter().any(is_travel));
        match family {
            Some(family) => {
                let ((travel, example), field) = (family.travel(), self.name());
                Error::undecided(
                    format!(
                        "expected the elevator's deflection, found {field}, {travel} of a travel that the log \
                         does not tell, positive nose up"
                    ),
                    format!("--units {name}={example}"),
                )
            }
            None => Error::undecided(
                format!("expected a unit of {}, found none", self.name()),
                format!("--units {name}="),
            ),
        }
    }
}
