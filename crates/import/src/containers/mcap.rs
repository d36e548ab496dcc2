//! MCAP (<https://mcap.dev/spec>): channels of ROS 2 (CDR) and ROS 1, in chunks or not, plain, LZ4 or Zstandard.
//!
//! A chunk whose checksum is wrong is skipped; of one that was cut off what remains is read. The index is not needed.
//!
//! Weighed: the crate `mcap` 0.26 (MIT), which the tests write with. Its readers end at the first record that is damaged, and it
//! unpacks with libraries of C.

use std::collections::BTreeMap;

use super::Decoded;
use super::bytes::Bytes;
use super::imu_message::Encoding;
use super::topics::{SENSORS, TIME, Topics};
use super::unpack::{Budget, Compression};
use super::walk::{Framing, Step, Walk};
use crate::damage::Fault;
use crate::error::Error;
use crate::formats::{Description, Format};
use crate::options::Options;

pub(crate) const MCAP: Description = Description {
    format: Format::Mcap,
    name: "mcap",
    title: "MCAP",
    is_it: None,
    time: &[(TIME, "us")],
    sensors: SENSORS,
    acceleration: "m/s2",
    rate: "rad/s",
    is_a_guess: false,
};

const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
/// Kind and length of a record.
const HEADER: usize = 9;
/// Kinds of records.
const SCHEMA: u8 = 3;
const CHANNEL: u8 = 4;
const MESSAGE: u8 = 5;
const CHUNK: u8 = 6;

/// Whether a file begins as MCAP does.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Reads a file.
///
/// # Errors
/// If it holds no inertial sensor, or several and nobody says which, or unpacks to too much.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let mut reader = Reader::default();
    reader.records(bytes.get(MAGIC.len()..).unwrap_or_default(), Level::File)?;
    reader.topics.decoded(&MCAP, options)
}

/// Where records are.
#[derive(Clone, Copy, PartialEq)]
enum Level {
    File,
    Chunk,
    /// In a chunk that was cut off, which is told already.
    CutChunk,
}

#[derive(Default)]
struct Reader {
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, (usize, Encoding)>,
    topics: Topics,
    budget: Budget,
    /// How many records there were.
    number: usize,
}

impl Reader {
    /// Reads the records of the file, or those in a chunk.
    fn records(&mut self, bytes: &[u8], level: Level) -> Result<(), Error> {
        let mut walk = Walk::new(bytes, self.number);
        while let Some(step) = walk.next(&Records) {
            self.number = walk.number;
            match step {
                Step::Record([CHUNK, rest @ ..]) if level == Level::File => {
                    self.chunk(rest.get(HEADER - 1..).unwrap_or_default())?;
                }
                Step::Record(record) => {
                    self.topics.losses.read += record.len();
                    if let [kind, rest @ ..] = record
                        && let Some(body) = rest.get(HEADER - 1..)
                    {
                        self.record(*kind, body);
                    }
                }
                Step::Lost(Fault::Cut, lost) => match lost {
                    [CHUNK, rest @ ..] if level == Level::File => {
                        self.topics.losses.add(Fault::Cut, walk.number, 0);
                        self.cut_chunk(rest.get(HEADER - 1..).unwrap_or_default())?;
                    }
                    _ if level == Level::CutChunk => {}
                    _ => self.topics.losses.add(Fault::Cut, walk.number, lost.len()),
                },
                Step::Lost(fault, lost) => {
                    self.topics.losses.add(fault, walk.number, lost.len());
                }
            }
            walk.number = self.number;
        }
        Ok(())
    }

    /// Reads a chunk, if it is sound.
    fn chunk(&mut self, body: &[u8]) -> Result<(), Error> {
        let number = self.number;
        let Some(chunk) = Chunk::of(body) else {
            self.topics.losses.add(Fault::Torn, number, body.len());
            return Ok(());
        };
        let packed = chunk.packed.get(..chunk.length).unwrap_or_default();
        let records = self.budget.unpack(chunk.compression, packed, chunk.size)?;
        let is_sound = records.len() as u64 == chunk.size
            && (chunk.checksum == 0 || chunk.checksum == crc32fast::hash(&records));
        if is_sound {
            return self.records(&records, Level::Chunk);
        }
        self.topics.losses.add(Fault::Torn, number, records.len().max(body.len()));
        Ok(())
    }

    /// Reads what remains of a chunk that was cut off.
    fn cut_chunk(&mut self, body: &[u8]) -> Result<(), Error> {
        let Some(chunk) = Chunk::of(body) else { return Ok(()) };
        let records = self.budget.unpack(chunk.compression, chunk.packed, chunk.size)?;
        self.records(&records, Level::CutChunk)
    }

    fn record(&mut self, kind: u8, body: &[u8]) {
        match kind {
            SCHEMA => drop(self.schema(body)),
            CHANNEL => drop(self.channel(body)),
            MESSAGE => drop(self.message(body)),
            _ => {}
        }
    }

    fn schema(&mut self, body: &[u8]) -> Option<()> {
        let mut bytes = Bytes(body);
        let (id, name) = (bytes.u16()?, bytes.counted()?);
        let name = String::from_utf8_lossy(name).into_owned();
        self.schemas.entry(id).or_insert(name);
        Some(())
    }

    fn channel(&mut self, body: &[u8]) -> Option<()> {
        let mut bytes = Bytes(body);
        let (id, schema) = (bytes.u16()?, bytes.u16()?);
        let (topic, encoding) = (bytes.counted()?, bytes.counted()?);
        let topic = String::from_utf8_lossy(topic);
        let encoding = match encoding {
            b"cdr" => Some(Encoding::Cdr),
            b"ros1" => Some(Encoding::Ros1),
            _ => None,
        };
        let kind = self.schemas.get(&schema).map_or("no type", String::as_str);
        if let (Some(place), Some(encoding)) = (self.topics.add(&topic, kind, encoding), encoding) {
            self.channels.entry(id).or_insert((place, encoding));
        }
        Some(())
    }

    fn message(&mut self, body: &[u8]) -> Option<()> {
        let mut bytes = Bytes(body);
        let (id, _sequence, logged, _published) =
            (bytes.u16()?, bytes.u32()?, bytes.u64()?, bytes.u64()?);
        let &(place, encoding) = self.channels.get(&id)?;
        self.topics.message(place, encoding, self.number, logged, bytes.0);
        Some(())
    }
}

/// A chunk of records.
struct Chunk<'a> {
    compression: Compression,
    /// How many bytes the records take, and what they sum up to.
    size: u64,
    checksum: u32,
    /// How many bytes they take as they are packed, and those, of which some may be missing.
    length: usize,
    packed: &'a [u8],
}

impl<'a> Chunk<'a> {
    fn of(body: &'a [u8]) -> Option<Self> {
        let mut bytes = Bytes(body);
        let (_start, _end, size, checksum) =
            (bytes.u64()?, bytes.u64()?, bytes.u64()?, bytes.u32()?);
        let compression = Compression::of(bytes.counted()?)?;
        let length = usize::try_from(bytes.u64()?).ok()?;
        Some(Self { compression, size, checksum, length, packed: bytes.0 })
    }
}

/// Records of MCAP: kind, length, body.
struct Records;

impl Framing for Records {
    fn length(&self, bytes: &[u8], is_in_sequence: bool) -> Option<usize> {
        if bytes.starts_with(&MAGIC) {
            return Some(MAGIC.len());
        }
        let (kind, length) = (bytes.first()?, bytes.get(1..HEADER));
        let is_known = matches!(kind, 1..=15 | 0x80..);
        let is_kind = *kind != 0 && (is_known || is_in_sequence);
        let Some(length) = length else { return is_kind.then_some(HEADER) };
        let length = usize::try_from(Bytes(length).u64()?).ok()?.checked_add(HEADER)?;
        is_kind.then_some(length)
    }

    fn follows(&self, bytes: &[u8]) -> bool {
        // A length of more than a PiB is none.
        bytes.starts_with(&MAGIC)
            || bytes.first().is_some_and(|&kind| kind != 0)
                && bytes.get(7..HEADER).is_none_or(|highest| highest == [0, 0])
    }

    fn candidate(&self, bytes: &[u8]) -> Option<usize> {
        // In a chunk that was cut off no record begins.
        let is_cut = match bytes {
            [CHUNK, rest @ ..] => rest.get(HEADER - 1..).and_then(Chunk::of).is_some(),
            _ => false,
        };
        let is_cut = is_cut && self.length(bytes, true).is_some_and(|length| length > bytes.len());
        (bytes.len() > HEADER && !is_cut).then_some(1)
    }
}
