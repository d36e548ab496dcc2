//! The inertial sensors in logs of `ArduPilot`, binary (`.bin`) or text (`.log`).
//!
//! `IMU` holds `TimeUS`, the sensor's number `I`, `GyrX` … in rad/s and `AccX` … in m/s²; older logs have `TimeMS`, and
//! `IMU2` and `IMU3` instead of a number; the oldest hold no times, so that their rate must be given.
//!
//! The frame is x forward, y right, z down, and the accelerometer gives specific force: −1 g along z at rest. That
//! amounts to a sensor mounted upside down, a rotation of all axes together, so no sign is changed.

use super::Decoded;
use super::ardupilot_text;
use super::dataflash::{self, Gather};
use super::gather::{Losses, Row, Stream};
use super::numbered::Numbered;
use crate::error::{Error, listed};
use crate::formats::{Description, Format};
use crate::options::Options;
use crate::part::Part;

pub(crate) const ARDUPILOT: Description = Description {
    format: Format::ArduPilot,
    name: "ardupilot",
    title: "ArduPilot",
    is_it: None,
    time: &[("TimeUS", "us"), ("TimeMS", "ms")],
    sensors: ["AccX", "AccY", "AccZ", "GyrX", "GyrY", "GyrZ"],
    acceleration: "m/s2",
    rate: "rad/s",
    is_a_guess: false,
};

/// The layout of an inertial sensor's message, as indices of its fields.
#[derive(Debug, Clone, PartialEq)]
struct Imu {
    time: Option<(usize, &'static str)>,
    sensors: [usize; 6],
    /// The sensor's number, and the index of the field that holds it, if there is one.
    number: (u32, Option<usize>),
}

impl Imu {
    /// The layout of a message with this name and these labels, if it is an inertial sensor's.
    fn of(name: &str, labels: &[&str]) -> Option<Self> {
        let own = match name {
            "IMU" => 0,
            "IMU2" => 1,
            "IMU3" => 2,
            _ => return None,
        };
        let place = |label: &str| labels.iter().position(|known| *known == label);
        let mut sensors = [0; 6];
        for (at, label) in sensors.iter_mut().zip(ARDUPILOT.sensors) {
            *at = place(label)?;
        }
        let mut times = ARDUPILOT.time.iter();
        let time = times.find_map(|(label, _)| Some((place(label)?, *label)));
        Some(Self { time, sensors, number: (own, place("I")) })
    }

    /// The sensor's number and the row of a message's fields.
    fn row(&self, field: impl Fn(usize) -> Option<f64>) -> Option<(u32, Row)> {
        let number = match self.number {
            (own, None) => own,
            (_, Some(place)) => {
                field(place).filter(|number| *number >= 0.0 && number.fract() == 0.0)? as u32
            }
        };
        let time = self.time.map_or(Some(f64::NAN), |(place, _)| field(place))?;
        let [ax, ay, az, gx, gy, gz] = self.sensors.map(&field);
        Some((number, [time, ax?, ay?, az?, gx?, gy?, gz?]))
    }
}

/// The data gathered from messages.
#[derive(Debug)]
struct Gathered {
    sensor: Numbered,
    losses: Losses,
    /// The label of the time column.
    time: &'static str,
    /// The names of the messages, for error messages.
    names: Vec<String>,
}

impl Gathered {
    fn new(options: &Options) -> Result<Self, Error> {
        let (losses, names) = (Losses::default(), Vec::new());
        Ok(Self { sensor: Numbered::new(options)?, losses, time: "nothing", names })
    }

    fn decoded(self, part: Part) -> Result<Decoded, Error> {
        if !self.sensor.is_seen() {
            let names = listed(self.names.iter().map(String::as_str));
            return Err(Error::log(format!(
                "expected messages IMU with GyrX and AccX of ArduPilot, found {names}"
            )));
        }
        let note = self.sensor.note("IMU")?;
        let stream: Stream = self.sensor.stream;
        let table = stream.table(&ARDUPILOT, self.time, &self.losses, part);
        Ok(Decoded { table, notes: note.into_iter().collect() })
    }
}

impl Gather for Gathered {
    type Layout = Imu;

    fn define(&mut self, name: &str, labels: &[&str]) -> Option<Imu> {
        let imu = Imu::of(name, labels);
        if let Some((_, label)) = imu.as_ref().and_then(|imu| imu.time) {
            self.time = label;
        }
        // Further names are not listed.
        if self.names.len() < 20 {
            self.names.push(name.to_owned());
        }
        imu
    }

    fn take(
        &mut self,
        imu: &Imu,
        record: usize,
        field: &dyn Fn(usize) -> Option<f64>,
    ) -> Option<()> {
        let (number, row) = imu.row(field)?;
        self.sensor.push(number, record, row);
        Some(())
    }

    fn losses(&mut self) -> &mut Losses {
        &mut self.losses
    }
}

/// Reads a binary log.
///
/// # Errors
/// If it holds no inertial sensor, or not the wanted one.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let mut gathered = Gathered::new(options)?;
    dataflash::read(bytes, &mut gathered);
    gathered.decoded(Part::Record)
}

/// Reads a log of text.
///
/// # Errors
/// As [`read`]; also if there is no text.
pub(super) fn read_text(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let mut gathered = Gathered::new(options)?;
    ardupilot_text::read(bytes, &mut gathered)?;
    gathered.decoded(Part::Line)
}
