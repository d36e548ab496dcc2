//! The modules on the drone's serial ports, played from a recording: a satellite receiver and a `LoRa` module.

use core::convert::Infallible;
use core::fmt::{self, Write};

use drone_app::Degree;
use drone_app::site::{GROUND, LEVEL, ORIGIN, USER};
use embedded_io::{ErrorType, Read, ReadReady};
use heapless::Deque;

/// What a module sends and nobody has read yet.
pub(crate) struct Port(Deque<u8, 256>);

/// A receiver that knows where the drone is.
pub(crate) struct Gps {
    degree: Degree,
    sent: u32,
}

impl Port {
    pub(crate) const fn new() -> Self {
        Self(Deque::new())
    }

    fn line(&mut self, text: fmt::Arguments<'_>) {
        // What does not fit is lost, as on a port that nobody reads.
        let _ = self.write_fmt(format_args!("{text}\r\n"));
    }

    /// A frame of somebody's, and how strongly it came in (dBm), as REYAX's RYLR modules tell it.
    pub(crate) fn beacon(&mut self, address: u16, level: f32) {
        self.line(format_args!("+RCV={address},5,HELLO,{},9", libm::roundf(level)));
    }

    /// A beacon of the user's with this path loss, dB, and one of somebody else's before.
    pub(crate) fn loss(&mut self, loss: f32) {
        self.beacon(USER + 1, -60.0);
        self.beacon(USER, LEVEL - loss);
    }
}
