use cobs::{DecodeResult, DecoderState};

use crate::Message;
use crate::frame::{CHECKSUM, CONTENT, CRC, Origin, VERSION, VERSION_OF_FLEETS};
use crate::sequence::{Order, RESUMED_AFTER, Sequence};

/// A received frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Frame {
    /// The sender; `None` if the frame does not name it.
    pub origin: Option<Origin>,
    /// The sequence number, of 16 bits if the frame does not name its sender.
    pub sequence: u32,
    /// The place of that number among the earlier ones on the line; `None` for a frame that names its sender, as a line
    /// may have any number of such senders.
    pub order: Option<Order>,
    /// CRC-32 of the frame. It tells whether a second frame with the same number is a repetition or comes from another
    /// sender.
    pub checksum: u32,
    /// Content of the frame.
    pub message: Message,
}

/// Counts of the frames that arrived, were damaged, or are missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts {
    /// Good frames.
    pub received: u32,
    /// Pieces between two delimiters that cannot be whole frames: cut, too long, or noise.
    pub torn: u32,
    /// Frames whose checksum is wrong.
    pub corrupt: u32,
    /// Frames of another version, or with a message that this receiver does not know.
    pub unknown: u32,
    /// Sequence numbers that are missing between those of the good frames: torn, corrupt or never arrived. One that
    /// comes late, by up to 127 numbers, is not lost. Frames that name their sender do not count, as each device
    /// numbers its own.
    pub lost: u32,
    /// Good frames whose numbers were seen before or do not follow: frames that came twice, or from another sender.
    pub foreign: u32,
}

/// Reads frames from a stream of bytes in pieces of any length, and counts what was lost.
#[derive(Debug)]
pub struct Receiver {
    content: [u8; CONTENT],
    /// The length of the content so far. It may exceed the capacity: then the frame is too long.
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

    /// The frames that end within these bytes. Bytes are read as the iterator advances: if it is dropped early, what
    /// follows the last frame remains unread.
    pub fn frames<'a>(&'a mut self, bytes: &'a [u8]) -> Frames<'a> {
        Frames { receiver: self, bytes: bytes.iter() }
    }

    /// Takes one byte and returns the frame that it completes, if any.
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

    /// The counts so far.
    pub const fn counts(&self) -> Counts {
        self.counts
    }

    /// Checks and reads the complete content of a frame.
    fn take(&mut self, length: usize) -> Option<Frame> {
        let whole = self.content.get(..length).and_then(<[u8]>::split_last_chunk::<CHECKSUM>);
        let Some((checked, checksum)) = whole else {
            count(&mut self.counts.torn);
            return None;
        };
        let checksum = u32::from_le_bytes(*checksum);
        if CRC.checksum(checked) != checksum {
            count(&mut self.counts.corrupt);
            return None;
        }
        let Some((sender, message)) = read(checked) else {
            count(&mut self.counts.unknown);
            return None;
        };
        count(&mut self.counts.received);
        Some(match sender {
            Sender::OfTheLine(sequence) => {
                let order = self.sequence.take(sequence);
                self.counts.place(order);
                let (sequence, order) = (sequence.into(), Some(order));
                Frame { origin: None, sequence, order, checksum, message }
            }
            Sender::Device(origin, sequence) => {
                Frame { origin: Some(origin), sequence, order: None, checksum, message }
            }
        })
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
                // The foreign frames just before were this sender's, too.
                self.foreign = self.foreign.saturating_sub(u32::from(RESUMED_AFTER) - 1);
            }
        }
    }
}

/// The sender of a frame, and the frame's sequence number.
enum Sender {
    OfTheLine(u16),
    Device(Origin, u32),
}

/// Reads a frame whose checksum is right, if it is understood to the last byte.
fn read(checked: &[u8]) -> Option<(Sender, Message)> {
    let (&version, rest) = checked.split_first()?;
    let (sender, message) = match version {
        VERSION => {
            let (&sequence, message) = rest.split_first_chunk()?;
            (Sender::OfTheLine(u16::from_le_bytes(sequence)), message)
        }
        VERSION_OF_FLEETS => {
            let (&device, rest) = rest.split_first_chunk()?;
            let (&boot, rest) = rest.split_first_chunk()?;
            let (&sequence, message) = rest.split_first_chunk()?;
            let [device, boot, sequence] = [device, boot, sequence].map(u32::from_le_bytes);
            (Sender::Device(Origin { device, boot }, sequence), message)
        }
        _ => return None,
    };
    let (message, rest) = postcard::take_from_bytes(message).ok()?;
    rest.is_empty().then_some((sender, message))
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
