//! Frames of RTCM 3 from a serial port.

use embedded_io::{Read, ReadReady};
use heapless::Vec;
use kestirim_gnss_message::{frame_data, frame_length};

/// The longest frame, bytes.
const LONGEST: usize = 1029;

/// A port, and the frame being received.
#[derive(Debug)]
pub(crate) struct Frames<P> {
    port: P,
    frame: Vec<u8, LONGEST>,
    /// The number of frames with a wrong checksum.
    pub(crate) damaged: u32,
}

impl<P: Read + ReadReady> Frames<P> {
    pub(crate) const fn new(port: P) -> Self {
        Self { port, frame: Vec::new(), damaged: 0 }
    }

    /// Reads what has arrived, and passes on the data of each complete frame; does not block.
    pub(crate) fn each(&mut self, mut read: impl FnMut(&[u8])) -> Result<(), P::Error> {
        let mut byte = [0];
        while self.port.read_ready()? && self.port.read(&mut byte)? > 0 {
            // There is always room: nothing longer than a frame is kept.
            if self.frame.extend_from_slice(&byte).is_err() {
                self.frame.clear();
            }
            while self.is_complete() {
                if let Some(data) = frame_data(&self.frame) {
                    read(data);
                    self.frame.clear();
                } else {
                    self.damaged = self.damaged.saturating_add(1);
                    self.skip_byte();
                }
            }
        }
        Ok(())
    }

    /// Whether as much has come as the beginning of a frame promises. Drops what no frame begins with.
    fn is_complete(&mut self) -> bool {
        while self.frame.len() >= 3 {
            match frame_length(&self.frame) {
                Some(length) => return self.frame.len() >= length,
                None => self.skip_byte(),
            }
        }
        false
    }

    /// A frame may begin within what looked like one.
    fn skip_byte(&mut self) {
        self.frame.rotate_left(1);
        self.frame.pop();
    }
}
