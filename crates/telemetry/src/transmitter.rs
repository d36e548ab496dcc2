use embedded_io::Write;

use crate::{CAPACITY, Message, encode};

/// Sends messages over a serial port and numbers them.
#[derive(Debug)]
pub struct Transmitter<W> {
    port: W,
    next: u16,
}

impl<W: Write> Transmitter<W> {
    /// A sender that begins with number 0.
    pub const fn new(port: W) -> Self {
        Self { port, next: 0 }
    }

    /// Sends a message. Its number is used up even if it fails, so that the receiver misses it.
    ///
    /// # Errors
    /// The port's.
    pub fn send(&mut self, message: impl Into<Message>) -> Result<(), W::Error> {
        let sequence = self.next;
        self.next = sequence.wrapping_add(1);
        let mut buffer = [0; CAPACITY];
        match encode(&message.into(), sequence, &mut buffer) {
            Ok(frame) => self.port.write_all(frame),
            // Cannot be: the capacity is that of the longest message.
            Err(_) => Ok(()),
        }
    }

    /// The port, when nothing more is to be sent.
    pub fn release(self) -> W {
        self.port
    }
}
