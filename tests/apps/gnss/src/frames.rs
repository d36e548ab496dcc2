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
            while let Some(length) = self.complete() {
                let data = self.frame.get(..length).and_then(frame_data);
                if let Some(data) = data {
                    read(data);
                    self.skip(length);
                } else {
                    // A frame may begin within what looked like one.
                    self.damaged = self.damaged.saturating_add(1);
                    self.skip(1);
                }
            }
        }
        Ok(())
    }

    /// The length of the first frame, if as much has come as its beginning promises. Drops what no frame begins with.
    fn complete(&mut self) -> Option<usize> {
        while self.frame.len() >= 3 {
            match frame_length(&self.frame) {
                Some(length) => return (self.frame.len() >= length).then_some(length),
                None => self.skip(1),
            }
        }
        None
    }

    /// Drops the first bytes.
    fn skip(&mut self, count: usize) {
        let count = count.min(self.frame.len());
        self.frame.rotate_left(count);
        self.frame.truncate(self.frame.len().saturating_sub(count));
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use kestirim_gnss_message::crc_24q;
    use std::vec::Vec;

    /// A frame with these data.
    fn frame(data: &[u8]) -> Vec<u8> {
        let mut frame = std::vec![0xd3, 0, data.len() as u8];
        frame.extend(data);
        frame.extend(&crc_24q(&frame).to_be_bytes()[1..]);
        frame
    }

    #[test]
    fn what_looks_like_a_frame_costs_none_behind_it() {
        let whole: [&[u8]; 4] = [&[1; 14], &[2; 30], &[3; 9], &[4; 20]];
        // Its length reaches into the second frame behind it.
        let stream = [&[0xd3, 0, 0x20, 7], whole.map(frame).concat().as_slice()].concat();
        let mut frames = Frames::new(stream.as_slice());
        let mut read = Vec::new();
        frames.each(|data| read.push(data.to_vec())).unwrap();
        assert_eq!(read, whole.map(<[u8]>::to_vec));
        assert_eq!(frames.damaged, 1);
    }
}
