use cobs::{DecodeResult, DecoderState};

use crate::Message;
use crate::frame::{CHECKSUM, CONTENT, CRC, VERSION};
use crate::sequence::{Order, RESUMED_AFTER, Sequence};

/// A message that arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Frame {
    /// The sender's count of frames.
    pub sequence: u16,
    /// Where that number stands among those before.
    pub order: Order,
    /// Content of the frame.
    pub message: Message,
}

/// Counts of the frames that arrived, were damaged, or are missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts {
    /// Good frames.
    pub received: u32,
    /// Pieces between two delimiters that cannot have been a whole frame: cut, too long, or noise.
    pub torn: u32,
    /// Frames whose checksum is wrong.
    pub corrupt: u32,
    /// Frames of another version, or with a message that this receiver does not know.
    pub unknown: u32,
    /// Sequence numbers that are missing between those of the good frames: torn, corrupt or never arrived. One that
    /// comes late, up to 127 numbers, is not lost.
    pub lost: u32,
    /// Good frames whose numbers came before, or do not follow: frames that came twice, or of another sender.
    pub foreign: u32,
}

/// Reads frames from a stream of bytes in pieces of any length, and counts what was lost.
#[derive(Debug)]
pub struct Receiver {
    content: [u8; CONTENT],
    /// May exceed the capacity: then the frame is too long.
    length: usize,
    state: DecoderState,
    sequence: Sequence,
    counts: Counts,
}

impl Default for Receiver {
    fn default() -> Self {
        Self::new()
    }
}

impl Receiver {
    /// A receiver that has seen nothing.
    pub const fn new() -> Self {
        Self {
            content: [0; CONTENT],
            length: 0,
            state: DecoderState::Idle,
            sequence: Sequence::new(),
            counts: Counts { received: 0, torn: 0, corrupt: 0, unknown: 0, lost: 0, foreign: 0 },
        }
    }

    /// The frames that end within these bytes. Bytes are read as the iterator is asked: drop it early, and
    /// what follows the last frame is unread.
    pub fn frames<'a>(&'a mut self, bytes: &'a [u8]) -> Frames<'a> {
        Frames { receiver: self, bytes: bytes.iter() }
    }

    /// Takes one byte and answers with the frame that it completes, if any.
    pub fn push(&mut self, byte: u8) -> Option<Frame> {
        match self.state.feed(byte) {
            Ok(DecodeResult::NoData) => None,
            Ok(DecodeResult::DataContinue(byte)) => {
                if let Some(place) = self.content.get_mut(self.length) {
                    *place = byte;
                }
                self.length = self.length.saturating_add(1);
                None
            }
            Ok(DecodeResult::DataComplete) => {
                let length = core::mem::take(&mut self.length);
                self.take(length)
            }
            // The decoder is at a delimiter again.
            Err(_) => {
                self.length = 0;
                count(&mut self.counts.torn);
                None
            }
        }
    }

    /// Counts so far.
    pub const fn counts(&self) -> Counts {
        self.counts
    }

    /// Takes the whole content of a frame.
    fn take(&mut self, length: usize) -> Option<Frame> {
        let whole = self.content.get(..length).and_then(<[u8]>::split_last_chunk::<CHECKSUM>);
        let Some((checked, checksum)) = whole else {
            count(&mut self.counts.torn);
            return None;
        };
        if CRC.checksum(checked) != u32::from_le_bytes(*checksum) {
            count(&mut self.counts.corrupt);
            return None;
        }
        let Some((sequence, message)) = read(checked) else {
            count(&mut self.counts.unknown);
            return None;
        };
        count(&mut self.counts.received);
        let order = self.sequence.take(sequence);
        self.counts.place(order);
        Some(Frame { sequence, order, message })
    }
}

impl Counts {
    fn place(&mut self, order: Order) {
        match order {
            Order::Newest { missing } => self.lost = self.lost.saturating_add(missing.into()),
            Order::Late { .. } => self.lost = self.lost.saturating_sub(1),
            Order::Foreign => count(&mut self.foreign),
            Order::Resumed { missing } => {
                self.lost = self.lost.saturating_add(missing.into());
                // Those before in a row were this sender's, too.
                self.foreign = self.foreign.saturating_sub(u32::from(RESUMED_AFTER) - 1);
            }
        }
    }
}

/// Reads a frame whose checksum is right, if this version understands it to the last byte.
fn read(checked: &[u8]) -> Option<(u16, Message)> {
    let (&[version, low, high], message) = checked.split_first_chunk()?;
    if version != VERSION {
        return None;
    }
    let (message, rest) = postcard::take_from_bytes(message).ok()?;
    rest.is_empty().then_some((u16::from_le_bytes([low, high]), message))
}

fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}

/// The frames of a piece of the stream: see [`Receiver::frames`].
#[derive(Debug)]
pub struct Frames<'a> {
    receiver: &'a mut Receiver,
    bytes: core::slice::Iter<'a, u8>,
}

impl Iterator for Frames<'_> {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        let receiver = &mut *self.receiver;
        self.bytes.find_map(|&byte| receiver.push(byte))
    }
}
