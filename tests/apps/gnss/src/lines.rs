//! Lines of text from a serial port.

use embedded_io::{Read, ReadReady};
use heapless::Vec;

/// The capacity for a line, more than the longest line of either format.
const LONGEST: usize = 128;

/// A port, and the line being received.
#[derive(Debug)]
pub(crate) struct Lines<P> {
    port: P,
    line: Vec<u8, LONGEST>,
    overlong: bool,
}

impl<P: Read + ReadReady> Lines<P> {
    pub(crate) const fn new(port: P) -> Self {
        Self { port, line: Vec::new(), overlong: false }
    }

    /// Reads what has arrived, and passes on each complete line; does not block. A line that is not text is passed on
    /// empty.
    pub(crate) fn each(&mut self, mut read: impl FnMut(&str)) -> Result<(), P::Error> {
        let mut byte = [0];
        while self.port.read_ready()? && self.port.read(&mut byte)? > 0 {
            if byte != *b"\n" {
                self.overlong |= self.line.extend_from_slice(&byte).is_err();
                continue;
            }
            match str::from_utf8(&self.line) {
                Ok(text) if !self.overlong => read(text.trim_ascii_end()),
                _ => read(""),
            }
            self.line.clear();
            self.overlong = false;
        }
        Ok(())
    }
}
