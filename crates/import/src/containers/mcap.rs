//! MCAP (<https://mcap.dev/spec>): channels of ROS 2 (CDR) and ROS 1, in chunks or not, uncompressed, LZ4 or Zstandard.
//! The index is not needed.
//!
//! Considered instead: the crate `mcap` 0.26 (MIT), with which the tests write. Its readers stop at the first damaged
//! record, and it decompresses with C libraries.

use std::collections::BTreeMap;

use super::Decoded;
use super::bytes::Bytes;
use super::chunks::{self, Announced, Chunk, Messages, Records, is_cut_chunk};
use super::imu_message::Encoding;
use super::level_topics::LevelTopics;
use super::range_topics::RangeTopics;
use super::topics::{self, Topics};
use super::unpack::Compression;
use super::walk::Framing;
use crate::error::Error;
use crate::formats::{Description, Format};
use crate::options::Options;

pub(crate) const MCAP: Description = topics::description(Format::Mcap, "mcap", "MCAP");

const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
/// The size of a record's kind and length, bytes.
const HEADER: usize = 9;
/// Kinds of records.
const SCHEMA: u8 = 3;
const CHANNEL: u8 = 4;
const MESSAGE: u8 = 5;
const CHUNK: u8 = 6;

/// Whether a file begins with the magic of MCAP.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Reads a file.
///
/// # Errors
/// If it holds no inertial sensor, or several and no option chooses, or unpacks to too much.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let records = bytes.get(MAGIC.len()..).unwrap_or_default();
    chunks::read(records, Mcap::default(), Topics::default())?.decoded(&MCAP, options)
}

/// Reads the ranges of a file.
///
/// # Errors
/// If it unpacks to too much.
pub(super) fn ranges<'o>(bytes: &[u8], options: &'o Options) -> Result<RangeTopics<'o>, Error> {
    let records = bytes.get(MAGIC.len()..).unwrap_or_default();
    chunks::read(records, Mcap::default(), RangeTopics::new(options))
}

/// Reads the levels of a file.
///
/// # Errors
/// If it unpacks to too much.
pub(super) fn levels<'o>(bytes: &[u8], options: &'o Options) -> Result<LevelTopics<'o>, Error> {
    let records = bytes.get(MAGIC.len()..).unwrap_or_default();
    chunks::read(records, Mcap::default(), LevelTopics::new(options))
}

/// The content of a schema: the name of a type, and its definition if that is a text of ROS or a description of
/// protobuf.
#[derive(Debug)]
struct Schema {
    name: String,
    definition: Vec<u8>,
}

/// The schemas and channels read so far.
#[derive(Debug, Default)]
struct Mcap {
    schemas: BTreeMap<u16, Schema>,
    channels: BTreeMap<u16, (usize, Encoding)>,
}

impl Mcap {
    fn schema(&mut self, body: &[u8]) -> Option<()> {
        let mut bytes = Bytes(body);
        let (id, name) = (bytes.u16()?, bytes.counted()?);
        let (encoding, definition) = (bytes.counted(), bytes.counted());
        let is_known_form = matches!(encoding, Some(b"ros1msg" | b"ros2msg" | b"protobuf"));
        let definition = definition.filter(|_| is_known_form).unwrap_or_default().to_vec();
        let name = String::from_utf8_lossy(name).into_owned();
        self.schemas.entry(id).or_insert(Schema { name, definition });
        Some(())
    }

    fn channel(&mut self, body: &[u8], messages: &mut impl Messages) -> Option<()> {
        let mut bytes = Bytes(body);
        let (id, schema) = (bytes.u16()?, bytes.u16()?);
        let (topic, encoding) = (bytes.counted()?, bytes.counted()?);
        let topic = String::from_utf8_lossy(topic);
        let encoding = match encoding {
            b"cdr" => Some(Encoding::Cdr),
            b"ros1" => Some(Encoding::Ros1),
            b"protobuf" => Some(Encoding::Protobuf),
            _ => None,
        };
        let schema = self.schemas.get(&schema);
        let kind = schema.map_or("no type", |schema| schema.name.as_str());
        let definition = schema.map_or(&[][..], |schema| &schema.definition);
        let announced = Announced { name: &topic, kind, encoding, definition };
        if let (Some(place), Some(encoding)) = (messages.topic(&announced), encoding) {
            self.channels.entry(id).or_insert((place, encoding));
        }
        Some(())
    }

    fn message(&self, body: &[u8], number: usize, messages: &mut impl Messages) -> Option<()> {
        let mut bytes = Bytes(body);
        let (id, _sequence, logged, _published) =
            (bytes.u16()?, bytes.u32()?, bytes.u64()?, bytes.u64()?);
        let &(place, encoding) = self.channels.get(&id)?;
        messages.message(place, encoding, number, logged, bytes.0);
        Some(())
    }
}

impl Records for Mcap {
    fn chunk(record: &[u8]) -> Option<Chunk<'_>> {
        if record.first() != Some(&CHUNK) {
            return None;
        }
        let mut bytes = Bytes(record.get(HEADER..).unwrap_or_default());
        let mut chunk = || {
            let (_start, _end) = (bytes.u64()?, bytes.u64()?);
            let (size, checksum) = (bytes.u64()?, bytes.u32()?);
            let compression = Compression::of(bytes.counted()?);
            let length = usize::try_from(bytes.u64()?).ok()?;
            Some(Chunk { compression, size, checksum, length, packed: bytes.0 })
        };
        Some(chunk().unwrap_or_default())
    }

    fn record<M: Messages>(&mut self, record: &[u8], number: usize, messages: &mut M) {
        let Some((kind, body)) = record.first().zip(record.get(HEADER..)) else { return };
        match *kind {
            SCHEMA => drop(self.schema(body)),
            CHANNEL => drop(self.channel(body, messages)),
            MESSAGE => drop(self.message(body, number, messages)),
            _ => {}
        }
    }
}

impl Framing for Mcap {
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
        // A length of 2⁴⁸ or more is implausible.
        bytes.starts_with(&MAGIC)
            || bytes.first().is_some_and(|&kind| kind != 0)
                && bytes.get(7..HEADER).is_none_or(|highest| highest == [0, 0])
    }

    fn candidate(&self, bytes: &[u8]) -> Option<usize> {
        (bytes.len() > HEADER && !is_cut_chunk(self, bytes)).then_some(1)
    }
}
