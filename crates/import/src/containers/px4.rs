//! Logs of PX4: `ULog` (`.ulg`), version 1 (<https://docs.px4.io/main/en/dev_log/ulog_file_format.html>).
//!
//! Of the topics `sensor_combined`, `vehicle_imu` and the pair `sensor_gyro` and `sensor_accel` the first that is there is
//! read. `sensor_combined` holds `gyro_rad` and `accelerometer_m_s2`, both as if of the gyroscope's `timestamp`, from which
//! the accelerometer's is some milliseconds away. `vehicle_imu` holds increments of angle and velocity, which are divided by
//! their intervals. Of the pair the accelerometer is interpolated onto the gyroscope's times.
//!
//! The frame is x forward, y right, z down, and the accelerometer gives specific force: −1 g along z at rest. That is a
//! sensor mounted upside down, a turn of all axes together, so no sign is changed.
//!
//! Weighed: the crate `px4-ulog` 0.6 (MIT) ends at the first record that is damaged, needs a path for data that were
//! appended, holds assertions about what it was fed, and flattens types that hold each other without a bound.

use std::collections::BTreeMap;

use super::Decoded;
use super::bytes::Bytes;
use super::gather::{Losses, Row};
use super::join::join;
use super::numbered::Numbered;
use super::ulog::{Formats, Place};
use super::walk::{Step, Walk};
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

const MAGIC: [u8; 7] = *b"ULog\x01\x12\x35";
/// Magic, version and time.
const HEADER: usize = 16;
/// What stands instead of the accelerometer's time if it said nothing yet.
const INVALID: f64 = i32::MAX as f64;
/// A second in the unit of times.
const SECOND: f64 = 1e6;
/// Names of the topics, in the order in which they are preferred.
const TOPICS: [&str; 4] = ["sensor_combined", "vehicle_imu", "sensor_gyro", "sensor_accel"];

/// Whether a file begins as `ULog` does.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Where a topic's records hold what: places of time, of two sensors, and of one or two other numbers.
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

/// Reads a log.
///
/// # Errors
/// If it holds no inertial sensor, or not the one that is wanted, or data that need a newer reader.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let sensor = || Numbered::new(options);
    let mut reader = Reader {
        formats: Formats::default(),
        layouts: BTreeMap::new(),
        losses: Losses::default(),
        sensors: [sensor()?, sensor()?, sensor()?, sensor()?],
        dropouts: (0, 0),
    };
    let mut number = 0;
    for section in sections(bytes)? {
        number = reader.section(section, number);
    }
    reader.decoded()
}

/// The main section, and those that were appended.
fn sections(bytes: &[u8]) -> Result<Vec<&[u8]>, Error> {
    let whole = bytes.get(HEADER..).unwrap_or_default();
    let flags = match whole {
        [_, _, b'B', flags @ ..] => Bytes(flags).take::<40>(),
        _ => None,
    };
    let Some(flags) = flags else { return Ok(vec![whole]) };
    let (incompatible, mut offsets) = (&flags[8..16], Bytes(&flags[16..]));
    let is_known = matches!(incompatible, [0 | 1, rest @ ..] if rest.iter().all(|&byte| byte == 0));
    if !is_known {
        return Err(Error::log("expected a ULog of version 1, found flags of a newer one"));
    }
    let mut sections = Vec::new();
    let mut from = HEADER;
    while let Some(offset) = offsets.take().map(u64::from_le_bytes)
        && let Ok(offset) = usize::try_from(offset)
        && incompatible[0] == 1
        && let Some(section) = bytes.get(from..offset)
    {
        sections.push(section);
        from = offset;
    }
    sections.push(bytes.get(from..).unwrap_or_default());
    Ok(sections)
}

/// What is gathered on the way.
struct Reader {
    formats: Formats,
    layouts: BTreeMap<u16, Layout>,
    losses: Losses,
    sensors: [Numbered; 4],
    /// How many, and ms.
    dropouts: (u32, u32),
}

impl Reader {
    /// Reads a section behind so many records: how many there are then.
    fn section(&mut self, bytes: &[u8], number: usize) -> usize {
        let mut walk = Walk::new(bytes, number);
        while let Some(step) = walk.next(&self.formats) {
            match step {
                Step::Record(record) => {
                    self.losses.read += record.len();
                    self.record(record, walk.number);
                }
                Step::Lost(fault, lost) => self.losses.add(fault, walk.number, lost.len()),
            }
        }
        walk.number
    }

    fn record(&mut self, record: &[u8], number: usize) {
        let [_, _, kind, body @ ..] = record else { return };
        match kind {
            b'F' => drop(self.formats.define(body)),
            b'A' => {
                let topic = self.formats.subscribe(body);
                let topic = topic.map(|(id, topic)| (id, topic.name.clone(), topic.instance));
                if let Some((id, name, instance)) = topic
                    && let Some(layout) = Layout::of(&mut self.formats, &name, instance)
                {
                    self.layouts.insert(id, layout);
                }
            }
            b'D' => {
                if let Some((id, data)) = self.formats.data(body)
                    && let Some(layout) = self.layouts.get(&id)
                    && let Some(row) = layout.row(data)
                {
                    self.sensors[layout.topic].push(layout.instance, number, row);
                }
            }
            b'O' => {
                let duration = Bytes(body).u16().unwrap_or(0);
                let (count, sum) = self.dropouts;
                self.dropouts = (count + 1, sum.saturating_add(u32::from(duration)));
            }
            _ => {}
        }
    }

    fn decoded(self) -> Result<Decoded, Error> {
        let mut notes = Vec::new();
        let [combined, imu, gyroscope, accelerometer] = self.sensors;
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
            // Another one of a topic is there, or none at all.
            other.transpose()?;
            return Err(none(&self.formats));
        };
        if let (count @ 1.., sum) = self.dropouts {
            notes.push(format!("dropouts of the logger: {count}, {sum} ms in all"));
        }
        let table = stream.table(&PX4, "timestamp", &self.losses, Part::Record);
        Ok(Decoded { table, notes })
    }
}

/// A log without an inertial sensor.
fn none(formats: &Formats) -> Error {
    let found = listed(formats.topics().map(|topic| topic.name.as_str()));
    Error::log(format!(
        "expected a topic sensor_combined, vehicle_imu, or sensor_gyro with sensor_accel, found {found}"
    ))
}
