//! Records of ROS files, some of which are chunks of other records, compressed or not.
//!
//! A chunk that is not sound is skipped; of a chunk that was cut off the remaining part is read.

use super::gather::Losses;
use super::imu_message::Encoding;
use super::unpack::{Budget, Compression};
use super::walk::{Framing, Step, Walk};
use crate::damage::Fault;
use crate::error::Error;

/// A chunk of records.
#[derive(Debug, Default)]
pub(super) struct Chunk<'a> {
    /// The compression; `None` if it is unknown, or if the chunk cannot be read at all.
    pub(super) compression: Option<Compression>,
    /// The uncompressed size of the records, bytes.
    pub(super) size: u64,
    /// The checksum of the uncompressed records; 0 if there is none.
    pub(super) checksum: u32,
    /// The compressed size, bytes, and the compressed records, of which the end may be missing.
    pub(super) length: usize,
    pub(super) packed: &'a [u8],
}

/// A topic as announced in a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Announced<'a> {
    pub(super) name: &'a str,
    pub(super) kind: &'a str,
    /// The encoding; `None` if it is unknown.
    pub(super) encoding: Option<Encoding>,
    /// The text that defines its messages; empty if it is missing.
    pub(super) definition: &'a [u8],
}

/// Collects data from messages.
pub(super) trait Messages {
    /// Takes an announced topic; returns its index if its messages are wanted.
    fn topic(&mut self, topic: &Announced<'_>) -> Option<usize>;

    /// Takes a message of a topic, with its time of receipt in ns since 1970.
    fn message(
        &mut self,
        place: usize,
        encoding: Encoding,
        record: usize,
        receipt: u64,
        message: &[u8],
    );

    /// The record of what could and could not be read.
    fn losses(&mut self) -> &mut Losses;
}

/// A file format that consists of such records.
pub(super) trait Records: Framing {
    /// The chunk in a record, if the record is one; its end may be missing.
    fn chunk(record: &[u8]) -> Option<Chunk<'_>>;

    /// Takes a record that is not a chunk, with its number.
    fn record<M: Messages>(&mut self, record: &[u8], number: usize, messages: &mut M);
}

/// Whether bytes begin with a chunk whose end is missing, so that no other record begins in them.
pub(super) fn is_cut_chunk<R: Records>(records: &R, bytes: &[u8]) -> bool {
    R::chunk(bytes).is_some_and(|chunk| chunk.compression.is_some())
        && records.length(bytes, true).is_some_and(|length| length > bytes.len())
}

/// The level at which records stand.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Level {
    File,
    Chunk,
    /// In a chunk that was cut off, which is already counted as damage.
    CutChunk,
}

/// Reads all records.
///
/// # Errors
/// If they unpack to too much.
pub(super) fn read<R: Records, M: Messages>(
    bytes: &[u8],
    records: R,
    messages: M,
) -> Result<M, Error> {
    let mut reader = Reader { records, messages, budget: Budget::default(), number: 0 };
    reader.walk(bytes, Level::File)?;
    Ok(reader.messages)
}

struct Reader<R, M> {
    records: R,
    messages: M,
    budget: Budget,
    /// The number of records so far.
    number: usize,
}

impl<R: Records, M: Messages> Reader<R, M> {
    fn walk(&mut self, bytes: &[u8], level: Level) -> Result<(), Error> {
        let mut walk = Walk::new(bytes, self.number);
        while let Some(step) = walk.next(&self.records) {
            self.number = walk.number;
            let chunk = |bytes| R::chunk(bytes).filter(|_| level == Level::File);
            match step {
                Step::Record(record) => {
                    if let Some(chunk) = chunk(record) {
                        self.chunk(&chunk, record.len())?;
                    } else {
                        self.messages.losses().read += record.len();
                        self.records.record(record, self.number, &mut self.messages);
                    }
                }
                Step::Lost(Fault::Cut, lost) => match chunk(lost) {
                    Some(chunk) => {
                        self.messages.losses().add(Fault::Cut, self.number, 0);
                        self.cut_chunk(&chunk)?;
                    }
                    None if level == Level::CutChunk => {}
                    None => self.messages.losses().add(Fault::Cut, self.number, lost.len()),
                },
                Step::Lost(fault, lost) => {
                    self.messages.losses().add(fault, self.number, lost.len());
                }
            }
            walk.number = self.number;
        }
        Ok(())
    }

    /// Reads a chunk, if it is sound.
    fn chunk(&mut self, chunk: &Chunk<'_>, length: usize) -> Result<(), Error> {
        let Some((compression, packed)) = chunk.compression.zip(chunk.packed.get(..chunk.length))
        else {
            self.messages.losses().add(Fault::Torn, self.number, length);
            return Ok(());
        };
        let records = self.budget.unpack(compression, packed, chunk.size)?;
        let is_sound = records.len() as u64 == chunk.size
            && (chunk.checksum == 0 || chunk.checksum == crc32fast::hash(&records));
        if is_sound {
            return self.walk(&records, Level::Chunk);
        }
        self.messages.losses().add(Fault::Torn, self.number, records.len().max(length));
        Ok(())
    }

    /// Reads what remains of a truncated chunk.
    fn cut_chunk(&mut self, chunk: &Chunk<'_>) -> Result<(), Error> {
        let Some(compression) = chunk.compression else { return Ok(()) };
        let records = self.budget.unpack(compression, chunk.packed, chunk.size)?;
        self.walk(&records, Level::CutChunk)
    }
}
