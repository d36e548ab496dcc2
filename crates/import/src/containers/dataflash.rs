//! Records of `DataFlash`, the format in which `ArduPilot` writes binary logs (`.bin`).
//!
//! Each message begins with `A3 95` and its type; those of type 128, `FMT`, define the length, name, types and labels
//! of the others (`libraries/AP_Logger/LogStructure.h` of `github.com/ArduPilot/ardupilot`, whose comments list the
//! letters of the types).
//!
//! There is no checksum: a message is accepted if another one or the end follows it. Considered instead: the crate
//! `ardupilot-binlog` 0.2 (MIT or Apache-2.0) goes on behind damage without reporting it, gives up after 256 faults,
//! and allocates each message by its names.

use super::bytes::{Bytes, padded_text};
use super::gather::Losses;
use super::walk::{Framing, Step, Walk};

const HEAD: [u8; 2] = [0xa3, 0x95];
/// The size of the magic bytes and the type.
const HEADER: usize = 3;
/// The type of the messages that define the others, and their length, bytes.
const FMT: u8 = 128;
const FMT_LENGTH: usize = 89;

/// Collects data from the messages of a log, binary or text.
pub(super) trait Gather {
    /// The layout of a message, as indices of its fields.
    type Layout;

    /// Takes the name and labels of a message type, once for each; returns its layout if it is wanted.
    fn define(&mut self, name: &str, labels: &[&str]) -> Option<Self::Layout>;

    /// Takes a message; `None` if a required field holds no number.
    fn take(
        &mut self,
        layout: &Self::Layout,
        record: usize,
        field: &dyn Fn(usize) -> Option<f64>,
    ) -> Option<()>;

    /// The record of what could and could not be read.
    fn losses(&mut self) -> &mut Losses;
}

/// Whether a file begins with a message.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    bytes.starts_with(&HEAD)
}

/// Reads all messages.
pub(super) fn read<G: Gather>(bytes: &[u8], gather: &mut G) {
    let mut formats = Formats::new();
    let mut walk = Walk::new(bytes, 0);
    while let Some(step) = walk.next(&formats) {
        let record = match step {
            Step::Record(record) => record,
            Step::Lost(fault, lost) => {
                gather.losses().add(fault, walk.number, lost.len());
                continue;
            }
        };
        let [_, _, kind, body @ ..] = record else { continue };
        if !record.starts_with(&HEAD) {
            continue;
        }
        gather.losses().read += record.len();
        if *kind == FMT {
            let _ = formats.define(body, gather);
        } else if let Some(Message { layout: Some(layout), fields, .. }) = formats.get(*kind) {
            let field = |place: usize| fields.get(place)?.value(body);
            let _ = gather.take(layout, walk.number, &field);
        }
    }
}

/// A field of a message: its offset behind the type, and the letter of its type.
#[derive(Debug, Clone, Copy)]
struct Field {
    from: usize,
    letter: u8,
}

impl Field {
    /// The size of a type, bytes.
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

    /// The value as a number; `None` for types that are not used for times, sensor numbers or axes.
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

/// The definition of messages of one type.
#[derive(Debug)]
struct Message<L> {
    length: usize,
    fields: Vec<Field>,
    layout: Option<L>,
}

/// The definitions of messages, by type.
#[derive(Debug)]
struct Formats<L>(Vec<Option<Message<L>>>);

impl<L> Formats<L> {
    fn new() -> Self {
        let mut formats = Self((0..=u8::MAX).map(|_| None).collect());
        if let Some(slot) = formats.0.get_mut(usize::from(FMT)) {
            *slot = Some(Message { length: FMT_LENGTH, fields: Vec::new(), layout: None });
        }
        formats
    }

    fn get(&self, kind: u8) -> Option<&Message<L>> {
        self.0.get(usize::from(kind))?.as_ref()
    }

    /// Takes an `FMT` message, if it is consistent in itself and the first for its type.
    fn define(&mut self, body: &[u8], gather: &mut impl Gather<Layout = L>) -> Option<()> {
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
            // Behind a field of unknown type the offsets are unknown.
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
        let labels = if labels.len() == fields.len() { &labels[..] } else { &[] };
        let layout = gather.define(name, labels);
        *slot = Some(Message { length, fields, layout });
        Some(())
    }
}

impl<L> Framing for Formats<L> {
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

/// Whether the rest only fills up the last page of a memory.
fn is_filling(bytes: &[u8]) -> bool {
    bytes.split_first().is_some_and(|(first, rest)| {
        matches!(first, 0 | 0xff) && rest.iter().all(|byte| byte == first)
    })
}
