//! MCAP (<https://mcap.dev/spec>): channels of ROS 2 (CDR) and ROS 1, in chunks or not, plain, LZ4 or Zstandard. The index is
//! not needed.
//!
//! Weighed: the crate `mcap` 0.26 (MIT), which the tests write with. Its readers end at the first record that is damaged, and it
//! unpacks with libraries of C.

use std::collections::BTreeMap;

use super::Decoded;
use super::bytes::Bytes;
use super::chunks::{self, Chunk, Records, is_cut_chunk};
use super::imu_message::Encoding;
use super::topics::{self, Topics};
use super::unpack::Compression;
use super::walk::Framing;
use crate::error::Error;
use crate::formats::{Description, Format};
use crate::options::Options;

pub(crate) const MCAP: Description = topics::description(Format::Mcap, "mcap", "MCAP");

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
    let records = bytes.get(MAGIC.len()..).unwrap_or_default();
    chunks::read(records, Mcap::default())?.decoded(&MCAP, options)
}

/// What is told of schemas and channels.
#[derive(Debug, Default)]
struct Mcap {
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, (usize, Encoding)>,
}

impl Mcap {
    fn schema(&mut self, body: &[u8]) -> Option<()> {
        let mut bytes = Bytes(body);
        let (id, name) = (bytes.u16()?, bytes.counted()?);
        let name = String::from_utf8_lossy(name).into_owned();
        self.schemas.entry(id).or_insert(name);
        Some(())
    }

    fn channel(&mut self, body: &[u8], topics: &mut Topics) -> Option<()> {
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
        if let (Some(place), Some(encoding)) = (topics.add(&topic, kind, encoding), encoding) {
            self.channels.entry(id).or_insert((place, encoding));
        }
        Some(())
    }

    fn message(&self, body: &[u8], number: usize, topics: &mut Topics) -> Option<()> {
        let mut bytes = Bytes(body);
        let (id, _sequence, logged, _published) =
            (bytes.u16()?, bytes.u32()?, bytes.u64()?, bytes.u64()?);
        let &(place, encoding) = self.channels.get(&id)?;
        topics.message(place, encoding, number, logged, bytes.0);
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

    fn record(&mut self, record: &[u8], number: usize, topics: &mut Topics) {
        let Some((kind, body)) = record.first().zip(record.get(HEADER..)) else { return };
        match *kind {
            SCHEMA => drop(self.schema(body)),
            CHANNEL => drop(self.channel(body, topics)),
            MESSAGE => drop(self.message(body, number, topics)),
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
        // A length of more than 2⁴⁸ is none.
        bytes.starts_with(&MAGIC)
            || bytes.first().is_some_and(|&kind| kind != 0)
                && bytes.get(7..HEADER).is_none_or(|highest| highest == [0, 0])
    }

    fn candidate(&self, bytes: &[u8]) -> Option<usize> {
        (bytes.len() > HEADER && !is_cut_chunk(self, bytes)).then_some(1)
    }
}
