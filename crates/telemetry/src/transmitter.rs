use embedded_io::Write;

use crate::frame::CAPACITY_OF_A_LINE;
use crate::{CAPACITY, Message, Origin, encode, encode_from};

/// Sends messages over a serial port and numbers them.
#[derive(Debug)]
pub struct Transmitter<W> {
    port: W,
    next: u16,
}

impl<W: Write> Transmitter<W> {
    /// A transmitter whose sequence numbers begin at 0.
    pub const fn new(port: W) -> Self {
        Self { port, next: 0 }
    }

    /// Sends a message. Its sequence number is used up even if this fails, so that the receiver misses it.
    ///
    /// # Errors
    /// Those of the port.
    pub fn send(&mut self, message: impl Into<Message>) -> Result<(), W::Error> {
        let sequence = self.next;
        self.next = sequence.wrapping_add(1);
        let mut buffer = [0; CAPACITY_OF_A_LINE];
        match encode(&message.into(), sequence, &mut buffer) {
            Ok(frame) => self.port.write_all(frame),
            // Cannot happen: the capacity is that of the longest message.
            Err(_) => Ok(()),
        }
    }

    /// Returns the port, when nothing more is to be sent.
    pub fn release(self) -> W {
        self.port
    }
}

/// Sends messages over a port that many devices share, numbers them and names the device.
#[derive(Debug)]
pub struct DeviceTransmitter<W> {
    port: W,
    origin: Origin,
    next: u32,
}

impl<W: Write> DeviceTransmitter<W> {
    /// A transmitter of a device that was just switched on: its sequence numbers begin at 0.
    pub const fn new(port: W, origin: Origin) -> Self {
        Self { port, origin, next: 0 }
    }

    /// Sends a message. Its sequence number is used up even if this fails, so that the receiver misses it.
    ///
    /// # Errors
    /// Those of the port.
    pub fn send(&mut self, message: impl Into<Message>) -> Result<(), W::Error> {
        let (origin, sequence) = (self.origin, self.next);
        self.next = sequence.wrapping_add(1);
        if self.next == 0 {
            self.origin.boot = origin.boot.saturating_add(1);
        }
        let mut buffer = [0; CAPACITY];
        match encode_from(origin, &message.into(), sequence, &mut buffer) {
            Ok(frame) => self.port.write_all(frame),
            // Cannot happen: the capacity is that of the longest message.
            Err(_) => Ok(()),
        }
    }

    /// Returns the port, when nothing more is to be sent.
    pub fn release(self) -> W {
        self.port
    }
}
