//! Logs of PX4: `ULog` (`.ulg`), version 1 (<https://docs.px4.io/main/en/dev_log/ulog_file_format.html>).
//!
//! The first that is present of the topics `sensor_combined`, `vehicle_imu` and the pair `sensor_gyro` and
//! `sensor_accel` is read. `sensor_combined` holds `gyro_rad` and `accelerometer_m_s2`, both taken to be at the
//! gyroscope's `timestamp`, from which the accelerometer's is some milliseconds away. `vehicle_imu` holds increments of
//! angle and velocity, which are divided by their intervals. Of the pair, the accelerometer is interpolated onto the
//! gyroscope's times.
//!
//! The frame is x forward, y right, z down, and the accelerometer gives specific force: −1 g along z at rest. That
//! amounts to a sensor mounted upside down, a rotation of all axes together, so no sign is changed.
//!
//! Considered instead: the crate `px4-ulog` 0.6 (MIT) stops at the first damaged record, needs a path to read appended
//! data, contains assertions about its input, and flattens nested types without a bound.

use super::Decoded;
use super::gather::Row;
use super::join::join;
use super::numbered::Numbered;
use super::ulog::{Formats, Place};
use super::ulog_reader::{self, Gather, Reading};
use crate::error::{Error, listed};
use crate::formats::{Description, Format};
use crate::options::Options;
use crate::part::Part;

pub(crate) const PX4: Description = Description {
    format: Format::Px4,
    name: "px4",
    title: "PX4 ULog",
    is_it: None,
    time: &[("timestamp", "us")],
    sensors: [
        "accelerometer_m_s2[0]",
        "accelerometer_m_s2[1]",
        "accelerometer_m_s2[2]",
        "gyro_rad[0]",
        "gyro_rad[1]",
        "gyro_rad[2]",
    ],
    acceleration: "m/s2",
    rate: "rad/s",
    is_a_guess: false,
};

/// The value that stands for the accelerometer's time as long as it has given none.
const INVALID: f64 = i32::MAX as f64;
/// One second in the unit of times.
const SECOND: f64 = 1e6;
/// The names of the topics, in order of preference.
const TOPICS: [&str; 4] = ["sensor_combined", "vehicle_imu", "sensor_gyro", "sensor_accel"];

/// The layout of a topic's records: the positions of time, of two sensors, and of one or two further numbers.
#[derive(Debug)]
struct Layout {
    topic: usize,
    instance: u32,
    time: Place,
    sensors: [Option<Place>; 6],
    others: [Option<Place>; 2],
}

impl Layout {
    fn of(formats: &mut Formats, topic: &str, instance: u8) -> Option<Self> {
        let kind = TOPICS.iter().position(|known| *known == topic)?;
        let mut place = |field: &str, index| formats.place(topic, field, index);
        let own = if kind == 0 { None } else { place("timestamp_sample", 0) };
        let time = own.or_else(|| place("timestamp", 0))?;
        let [force, rate] = match kind {
            0 => ["accelerometer_m_s2", "gyro_rad"],
            1 => ["delta_velocity", "delta_angle"],
            _ => ["", ""],
        };
        let mut sensors = [None; 6];
        for (at, slot) in sensors.iter_mut().enumerate() {
            let axis = ["x", "y", "z"][at % 3];
            *slot = match (kind, at) {
                (2, 0..3) | (3, 3..6) => None,
                (2 | 3, _) => Some(place(axis, 0)?),
                (_, 0..3) => Some(place(force, at % 3)?),
                _ => Some(place(rate, at % 3)?),
            };
        }
        let others = match kind {
            0 => [place("accelerometer_timestamp_relative", 0), None],
            1 => [Some(place("delta_velocity_dt", 0)?), Some(place("delta_angle_dt", 0)?)],
            _ => [None; 2],
        };
        Some(Self { topic: kind, instance: u32::from(instance), time, sensors, others })
    }

    fn row(&self, data: &[u8]) -> Option<Row> {
        let value = |place: Option<Place>| place.map_or(Some(f64::NAN), |place| place.value(data));
        let [ax, ay, az, gx, gy, gz] = self.sensors.map(value);
        let mut row = [self.time.value(data)?, ax?, ay?, az?, gx?, gy?, gz?];
        let [first, second] = self.others.map(value);
        let (first, second) = (first?, second?);
        if self.topic == 0 && first == INVALID {
            row[1..4].fill(f64::NAN);
        }
        if self.topic == 1 {
            row[1..4].iter_mut().for_each(|force| *force *= SECOND / first);
            row[4..7].iter_mut().for_each(|rate| *rate *= SECOND / second);
        }
        Some(row)
    }
}

/// The rows of each topic.
struct Sensors([Numbered; 4]);

impl Gather for Sensors {
    type Layout = Layout;

    fn define(&mut self, formats: &mut Formats, topic: &str, instance: u8) -> Option<Layout> {
        Layout::of(formats, topic, instance)
    }

    fn take(&mut self, layout: &Layout, record: usize, data: &[u8]) -> Option<()> {
        let row = layout.row(data)?;
        self.0.get_mut(layout.topic)?.push(layout.instance, record, row);
        Some(())
    }
}

/// Reads a log.
///
/// # Errors
/// If it holds no inertial sensor, or not the wanted one, or data that need a newer reader.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let sensor = || Numbered::new(options);
    let mut sensors = Sensors([sensor()?, sensor()?, sensor()?, sensor()?]);
    let reading = ulog_reader::read(bytes, &mut sensors)?;
    sensors.decoded(&reading)
}

impl Sensors {
    fn decoded(self, reading: &Reading) -> Result<Decoded, Error> {
        let mut notes = Vec::new();
        let [combined, imu, gyroscope, accelerometer] = self.0;
        let is_pair = gyroscope.is_seen() && accelerometer.is_seen();
        let has_rows = |sensor: &Numbered| sensor.stream.len() > 0;
        let mut single = [(combined, TOPICS[0]), (imu, TOPICS[1])].into_iter();
        let mut other = None;
        let found = single.find(|(sensor, name)| {
            if sensor.is_seen() && other.is_none() {
                other = Some(sensor.note(name));
            }
            has_rows(sensor)
        });
        let stream = if let Some((sensor, name)) = found {
            notes.push(sensor.note(name)?.unwrap_or_else(|| name.to_owned()));
            sensor.stream
        } else if is_pair {
            for (sensor, name) in [(&gyroscope, TOPICS[2]), (&accelerometer, TOPICS[3])] {
                notes.push(sensor.note(name)?.unwrap_or_else(|| name.to_owned()));
            }
            let (stream, note) = join(&gyroscope.stream, &accelerometer.stream, SECOND)?;
            notes.push(note);
            stream
        } else {
            // Report that another instance of the topic is present, or else that no topic is.
            other.transpose()?;
            return Err(none(&reading.formats));
        };
        notes.extend(reading.pauses());
        let table = stream.table(&PX4, "timestamp", &reading.losses, Part::Record);
        Ok(Decoded { table, notes })
    }
}

/// The error for a log without an inertial sensor.
fn none(formats: &Formats) -> Error {
    let found = listed(formats.topics().map(|topic| topic.name.as_str()));
    Error::log(format!(
        "expected a topic sensor_combined, vehicle_imu, or sensor_gyro with sensor_accel, found {found}"
    ))
}
