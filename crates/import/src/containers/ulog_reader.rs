//! Walks through the records of a `ULog`, in all its sections.

use std::collections::BTreeMap;

use super::bytes::Bytes;
use super::gather::Losses;
use super::ulog::Formats;
use super::walk::{Step, Walk};
use crate::error::Error;

const MAGIC: [u8; 7] = *b"ULog\x01\x12\x35";
/// The size of magic, version and time, bytes.
const HEADER: usize = 16;

/// Whether a file begins with the magic of `ULog`.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Collects data from the topics of a log.
pub(super) trait Gather {
    /// The layout of a topic's records.
    type Layout;

    /// Takes a topic; returns the layout of its records if they are wanted.
    fn define(&mut self, formats: &mut Formats, topic: &str, instance: u8) -> Option<Self::Layout>;

    /// Takes a record's data; `None` if they are too short.
    fn take(&mut self, layout: &Self::Layout, record: usize, data: &[u8]) -> Option<()>;
}

/// What is read apart from the collected data.
#[derive(Debug, Default)]
pub(super) struct Reading {
    pub(super) formats: Formats,
    pub(super) losses: Losses,
    /// The dropouts of the logger: their number, and their total duration in ms.
    dropouts: (u32, u32),
}

impl Reading {
    /// A sentence about dropouts of the logger, if there were any.
    pub(super) fn pauses(&self) -> Option<String> {
        let (count, sum) = self.dropouts;
        (count > 0).then(|| format!("dropouts of the logger: {count}, {sum} ms in all"))
    }
}

/// Reads all records.
///
/// # Errors
/// If the data need a newer reader.
pub(super) fn read<G: Gather>(bytes: &[u8], gather: &mut G) -> Result<Reading, Error> {
    let mut reader = Reader { reading: Reading::default(), layouts: BTreeMap::new(), gather };
    let mut number = 0;
    for section in sections(bytes)? {
        number = reader.section(section, number);
    }
    Ok(reader.reading)
}

/// The main section, and the appended ones.
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

struct Reader<'a, G: Gather> {
    reading: Reading,
    layouts: BTreeMap<u16, G::Layout>,
    gather: &'a mut G,
}

impl<G: Gather> Reader<'_, G> {
    /// Reads a section after `number` records; returns the number of records after it.
    fn section(&mut self, bytes: &[u8], number: usize) -> usize {
        let mut walk = Walk::new(bytes, number);
        while let Some(step) = walk.next(&self.reading.formats) {
            match step {
                Step::Record(record) => {
                    self.reading.losses.read += record.len();
                    self.record(record, walk.number);
                }
                Step::Lost(fault, lost) => {
                    self.reading.losses.add(fault, walk.number, lost.len());
                }
            }
        }
        walk.number
    }

    fn record(&mut self, record: &[u8], number: usize) {
        let [_, _, kind, body @ ..] = record else { return };
        let formats = &mut self.reading.formats;
        match kind {
            b'F' => drop(formats.define(body)),
            b'A' => {
                let topic = formats.subscribe(body);
                let topic = topic.map(|(id, topic)| (id, topic.name.clone(), topic.instance));
                if let Some((id, name, instance)) = topic
                    && let Some(layout) = self.gather.define(formats, &name, instance)
                {
                    self.layouts.insert(id, layout);
                }
            }
            b'D' => {
                if let Some((id, data)) = formats.data(body)
                    && let Some(layout) = self.layouts.get(&id)
                {
                    let _ = self.gather.take(layout, number, data);
                }
            }
            b'O' => {
                let duration = Bytes(body).u16().unwrap_or(0);
                let (count, sum) = self.reading.dropouts;
                self.reading.dropouts = (count + 1, sum.saturating_add(u32::from(duration)));
            }
            _ => {}
        }
    }
}
