//! Logs of `ArduPilot`: `DataFlash`, binary (`.bin`).
//!
//! Each message begins with `A3 95` and its type; those of type 128, `FMT`, tell the length, name, types and labels of the
//! others (`libraries/AP_Logger/LogStructure.h` of `github.com/ArduPilot/ardupilot`, whose comments list the letters of the
//! types). `IMU` holds `TimeUS`, the sensor's number `I`, `GyrX` … in rad/s and `AccX` … in m/s²; older logs have `TimeMS`,
//! and `IMU2` and `IMU3` instead of a number; the oldest hold no times, so that their rate has to be said.
//!
//! The frame is x forward, y right, z down, and the accelerometer gives specific force: −1 g along z at rest. That is a
//! sensor mounted upside down, a turn of all axes together, so no sign is changed.
//!
//! There is no checksum: a message is taken if another one or the end follows it. Weighed: the crate `ardupilot-binlog` 0.2 (MIT or
//! Apache-2.0) goes on behind damage without telling it, gives up after 256 faults, and allocates each message by its names.

use super::Decoded;
use super::bytes::{Bytes, padded_text};
use super::gather::{Losses, Row, Stream};
use super::numbered::Numbered;
use super::walk::{Framing, Step, Walk};
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

const HEAD: [u8; 2] = [0xa3, 0x95];
/// The head and the type.
const HEADER: usize = 3;
/// The type of messages that tell what others hold.
const FMT: u8 = 128;
const FMT_LENGTH: usize = 89;

/// Whether a file begins with a message.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    bytes.starts_with(&HEAD)
}

/// Where an inertial sensor's message holds what: places among its fields.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Imu {
    time: Option<(usize, &'static str)>,
    sensors: [usize; 6],
    /// Its number, and where that stands if it does.
    number: (u32, Option<usize>),
}

impl Imu {
    /// Of a message's name and labels, if it is an inertial sensor's.
    pub(super) fn of(name: &str, labels: &[&str]) -> Option<Self> {
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
    pub(super) fn row(&self, field: impl Fn(usize) -> Option<f64>) -> Option<(u32, Row)> {
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

/// What is gathered from messages.
#[derive(Debug)]
pub(super) struct Gathered {
    pub(super) sensor: Numbered,
    pub(super) losses: Losses,
    /// The name of time.
    pub(super) time: &'static str,
    /// Names of the messages that are told of.
    pub(super) names: Vec<String>,
}

impl Gathered {
    pub(super) fn new(options: &Options) -> Result<Self, Error> {
        let (losses, names) = (Losses::default(), Vec::new());
        Ok(Self { sensor: Numbered::new(options)?, losses, time: "nothing", names })
    }

    pub(super) fn define(&mut self, name: &str, imu: Option<&Imu>) {
        if let Some((_, label)) = imu.and_then(|imu| imu.time) {
            self.time = label;
        }
        // More are not told of.
        if self.names.len() < 20 {
            self.names.push(name.to_owned());
        }
    }

    pub(super) fn decoded(self, part: Part) -> Result<Decoded, Error> {
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

/// Reads a binary log.
///
/// # Errors
/// If it holds no inertial sensor, or not the one that is wanted.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let mut formats = Formats::new();
    let mut gathered = Gathered::new(options)?;
    let mut walk = Walk::new(bytes, 0);
    while let Some(step) = walk.next(&formats) {
        let record = match step {
            Step::Record(record) => record,
            Step::Lost(fault, lost) => {
                gathered.losses.add(fault, walk.number, lost.len());
                continue;
            }
        };
        let [_, _, kind, body @ ..] = record else { continue };
        if !record.starts_with(&HEAD) {
            continue;
        }
        gathered.losses.read += record.len();
        if *kind == FMT {
            if let Some((name, imu)) = formats.define(body) {
                gathered.define(&name, imu.as_ref());
            }
        } else if let Some(Message { imu: Some(imu), fields, .. }) = formats.get(*kind)
            && let Some((number, row)) = imu.row(|place| fields.get(place)?.value(body))
        {
            gathered.sensor.push(number, walk.number, row);
        }
    }
    gathered.decoded(Part::Record)
}

/// A field of a message: where it begins behind the type, and its type's letter.
#[derive(Debug, Clone, Copy)]
struct Field {
    from: usize,
    letter: u8,
}

impl Field {
    /// How many bytes a type takes.
    fn size(letter: u8) -> Option<usize> {
        Some(match letter {
            b'b' | b'B' | b'M' => 1,
            b'h' | b'H' | b'c' | b'C' | b'g' => 2,
            b'i' | b'I' | b'e' | b'E' | b'L' | b'f' | b'n' => 4,
            b'd' | b'q' | b'Q' => 8,
            b'N' => 16,
            b'a' | b'Z' => 64,
            _ => return None,
        })
    }

    /// A number; types that no time, number or axis has are none.
    fn value(self, body: &[u8]) -> Option<f64> {
        let mut bytes = Bytes(body.get(self.from..)?);
        Some(match self.letter {
            b'B' | b'M' => f64::from(bytes.u8()?),
            b'b' => f64::from(i8::from_le_bytes(bytes.take()?)),
            b'H' => f64::from(bytes.u16()?),
            b'h' => f64::from(i16::from_le_bytes(bytes.take()?)),
            b'C' => f64::from(bytes.u16()?) / 100.0,
            b'c' => f64::from(i16::from_le_bytes(bytes.take()?)) / 100.0,
            b'I' => f64::from(u32::from_le_bytes(bytes.take()?)),
            b'i' => f64::from(i32::from_le_bytes(bytes.take()?)),
            b'E' => f64::from(u32::from_le_bytes(bytes.take()?)) / 100.0,
            b'e' => f64::from(i32::from_le_bytes(bytes.take()?)) / 100.0,
            b'Q' => u64::from_le_bytes(bytes.take()?) as f64,
            b'q' => i64::from_le_bytes(bytes.take()?) as f64,
            b'f' => f64::from(f32::from_le_bytes(bytes.take()?)),
            b'd' => f64::from_le_bytes(bytes.take()?),
            _ => return None,
        })
    }
}

/// What messages of a type hold.
#[derive(Debug)]
struct Message {
    length: usize,
    fields: Vec<Field>,
    imu: Option<Imu>,
}

/// What messages of each type hold.
#[derive(Debug)]
struct Formats(Vec<Option<Message>>);

impl Formats {
    fn new() -> Self {
        let mut formats = Self((0..=u8::MAX).map(|_| None).collect());
        if let Some(slot) = formats.0.get_mut(usize::from(FMT)) {
            *slot = Some(Message { length: FMT_LENGTH, fields: Vec::new(), imu: None });
        }
        formats
    }

    fn get(&self, kind: u8) -> Option<&Message> {
        self.0.get(usize::from(kind))?.as_ref()
    }

    /// Takes a message `FMT` that is not in itself contradictory and told first of its type: its name, and whose it is.
    fn define(&mut self, body: &[u8]) -> Option<(String, Option<Imu>)> {
        let mut bytes = Bytes(body);
        let (kind, length) = (bytes.u8()?, usize::from(bytes.u8()?));
        let name = padded_text(bytes.slice(4)?)?;
        let letters = padded_text(bytes.slice(16)?)?;
        let labels = padded_text(bytes.slice(64)?)?;
        let labels: Vec<_> =
            labels.split(',').map(str::trim).filter(|label| !label.is_empty()).collect();
        let mut fields = Vec::new();
        let mut end = Some(0);
        for letter in letters.bytes() {
            // Behind a type that is not known yet nothing has a place.
            let Some(from) = end else { break };
            fields.push(Field { from, letter });
            end = Field::size(letter).map(|size| from + size);
        }
        let is_whole = end.is_none_or(|end| end + HEADER == length) && length > HEADER;
        let slot = self.0.get_mut(usize::from(kind))?;
        if !is_whole || slot.is_some() {
            return None;
        }
        // The end of a long list of labels may be missing.
        let imu = Imu::of(name, &labels).filter(|_| labels.len() == fields.len());
        *slot = Some(Message { length, fields, imu: imu.clone() });
        Some((name.to_owned(), imu))
    }
}

impl Framing for Formats {
    fn length(&self, bytes: &[u8], _: bool) -> Option<usize> {
        match bytes {
            [0xa3] | [0xa3, 0x95] => Some(FMT_LENGTH),
            [0xa3, 0x95, kind, ..] => self.get(*kind).map(|message| message.length),
            _ if is_filling(bytes) => Some(bytes.len()),
            _ => None,
        }
    }

    fn follows(&self, bytes: &[u8]) -> bool {
        HEAD.starts_with(bytes) || bytes.starts_with(&HEAD) || is_filling(bytes)
    }

    fn candidate(&self, bytes: &[u8]) -> Option<usize> {
        memchr::memmem::find(bytes.get(1..)?, &HEAD).map(|at| at + 1)
    }
}

/// Whether nothing follows but what fills the last page of a memory.
fn is_filling(bytes: &[u8]) -> bool {
    bytes.split_first().is_some_and(|(first, rest)| {
        matches!(first, 0 | 0xff) && rest.iter().all(|byte| byte == first)
    })
}
