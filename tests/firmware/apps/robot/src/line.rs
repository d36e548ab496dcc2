//! The telemetry's serial line.

use embedded_io::Write;
use kestirim_telemetry::{CAPACITY, Message, encode};

/// The line did not take a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub struct LineError;

/// Numbers frames and writes them.
pub(crate) struct Line<W> {
    writer: W,
    sequence: u16,
}

impl<W: Write> Line<W> {
    pub(crate) const fn new(writer: W) -> Self {
        Self { writer, sequence: 0 }
    }

    pub(crate) fn send(&mut self, message: impl Into<Message>) -> Result<(), LineError> {
        let mut buffer = [0; CAPACITY];
        let frame = encode(&message.into(), self.sequence, &mut buffer).map_err(|_| LineError)?;
        self.sequence = self.sequence.wrapping_add(1);
        self.writer.write_all(frame).map_err(|_| LineError)
    }
}
