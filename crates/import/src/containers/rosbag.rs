//! Bags of ROS 1, version 2.0 (<https://wiki.ros.org/Bags/Format/2.0>): with chunks that are uncompressed, bz2 or LZ4,
//! or without chunks. The index is not needed, so a bag that was not closed is read as well.
//!
//! Considered instead: the crate `rosbag` 0.6 (MIT or Apache-2.0, last release 2024) only takes a path, panics where a
//! bag was not closed, allocates as much memory as a header claims, and decompresses with C libraries.

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
use crate::error::{Error, quoted};
use crate::formats::{Description, Format};
use crate::options::Options;

pub(crate) const ROS1: Description = topics::description(Format::Ros1, "ros1", "ROS 1 bag");

const MAGIC: &[u8] = b"#ROSBAG V2.0\n";
/// The largest length of a record's header, bytes.
const LONGEST: usize = 1 << 16;
/// Kinds of records.
const MESSAGE: u8 = 2;
const CHUNK: u8 = 5;
const CONNECTION: u8 = 7;

/// Whether a file begins as a bag of any version.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    bytes.starts_with(b"#ROSBAG V")
}

/// Reads a bag.
///
/// # Errors
/// If it is of another version, holds no inertial sensor, or several and no option chooses, or unpacks to too much.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    chunks::read(contents(bytes)?, Bag::default(), Topics::default())?.decoded(&ROS1, options)
}

/// Reads the ranges of a bag.
///
/// # Errors
/// If it is of another version, or unpacks to too much.
pub(super) fn ranges<'o>(bytes: &[u8], options: &'o Options) -> Result<RangeTopics<'o>, Error> {
    chunks::read(contents(bytes)?, Bag::default(), RangeTopics::new(options))
}

/// Reads the levels of a bag.
///
/// # Errors
/// If it is of another version, or unpacks to too much.
pub(super) fn levels<'o>(bytes: &[u8], options: &'o Options) -> Result<LevelTopics<'o>, Error> {
    chunks::read(contents(bytes)?, Bag::default(), LevelTopics::new(options))
}

/// The records that follow the first line.
fn contents(bytes: &[u8]) -> Result<&[u8], Error> {
    bytes.strip_prefix(MAGIC).ok_or_else(|| {
        let line = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
        let found = quoted(&String::from_utf8_lossy(line));
        Error::log(format!("expected #ROSBAG V2.0, found {found}"))
    })
}

/// The connections read so far.
#[derive(Debug, Default)]
struct Bag {
    topics: BTreeMap<u32, usize>,
}

/// A record: its kind, the fields of its header, and its data, of which the end may be missing.
struct Record<'a> {
    kind: u8,
    header: &'a [u8],
    length: usize,
    data: &'a [u8],
}

impl<'a> Record<'a> {
    fn of(bytes: &'a [u8]) -> Option<Self> {
        let mut bytes = Bytes(bytes);
        let length = usize::try_from(bytes.u32()?).ok().filter(|&length| length <= LONGEST)?;
        let header = bytes.slice(length)?;
        let kind = match field(header, b"op")? {
            [kind @ 2..=7] => *kind,
            _ => return None,
        };
        let length = usize::try_from(bytes.u32()?).ok()?;
        Some(Self { kind, header, length, data: bytes.0 })
    }

    /// A four-byte number in the record's header.
    fn number(&self, name: &[u8]) -> Option<u32> {
        Bytes(field(self.header, name)?).u32()
    }
}

/// The value of a field in a header.
fn field<'a>(header: &'a [u8], name: &[u8]) -> Option<&'a [u8]> {
    let mut bytes = Bytes(header);
    loop {
        let field = bytes.counted()?;
        let value = field.strip_prefix(name).and_then(|rest| rest.strip_prefix(b"="));
        if value.is_some() {
            return value;
        }
        if !field.contains(&b'=') {
            return None;
        }
    }
}

impl Bag {
    fn connection(&mut self, record: &Record<'_>, messages: &mut impl Messages) -> Option<()> {
        let (id, topic) = (record.number(b"conn")?, field(record.header, b"topic")?);
        let kind = field(record.data, b"type")?;
        let [topic, kind] = [topic, kind].map(String::from_utf8_lossy);
        let (encoding, definition) =
            (Some(Encoding::Ros1), field(record.data, b"message_definition"));
        let definition = definition.unwrap_or_default();
        let announced = Announced { name: &topic, kind: &kind, encoding, definition };
        if let Some(place) = messages.topic(&announced) {
            self.topics.entry(id).or_insert(place);
        }
        Some(())
    }

    fn message(
        &self,
        record: &Record<'_>,
        number: usize,
        messages: &mut impl Messages,
    ) -> Option<()> {
        let &place = self.topics.get(&record.number(b"conn")?)?;
        let mut time = Bytes(field(record.header, b"time")?);
        let (seconds, nanoseconds) = (u64::from(time.u32()?), u64::from(time.u32()?));
        let receipt = seconds * 1_000_000_000 + nanoseconds;
        messages.message(place, Encoding::Ros1, number, receipt, record.data);
        Some(())
    }
}

impl Records for Bag {
    fn chunk(record: &[u8]) -> Option<Chunk<'_>> {
        let record = Record::of(record).filter(|record| record.kind == CHUNK)?;
        let compression = field(record.header, b"compression").and_then(Compression::of);
        let size = u64::from(record.number(b"size").unwrap_or(0));
        Some(Chunk { compression, size, checksum: 0, length: record.length, packed: record.data })
    }

    fn record<M: Messages>(&mut self, record: &[u8], number: usize, messages: &mut M) {
        let Some(record) = Record::of(record) else { return };
        match record.kind {
            CONNECTION => drop(self.connection(&record, messages)),
            MESSAGE => drop(self.message(&record, number, messages)),
            _ => {}
        }
    }
}

impl Framing for Bag {
    fn length(&self, bytes: &[u8], is_in_sequence: bool) -> Option<usize> {
        if let Some(record) = Record::of(bytes) {
            return (bytes.len() - record.data.len()).checked_add(record.length);
        }
        // The end of the header may be missing.
        let length = Bytes(bytes).u32().map_or(4, |length| length as usize);
        let is_cut = length <= LONGEST && length + 8 > bytes.len();
        (is_cut && is_in_sequence).then_some(bytes.len() + 1)
    }

    fn follows(&self, bytes: &[u8]) -> bool {
        self.length(bytes, true).is_some()
    }

    fn candidate(&self, bytes: &[u8]) -> Option<usize> {
        (bytes.len() > 8 && !is_cut_chunk(self, bytes)).then_some(1)
    }
}
