//! The devices' measurements: the file `stream.bin` in the emulator's working directory.
//!
//! A record is five words of four bytes, little-endian: microseconds since the previous record (`u32`), the range to
//! the anchor whose turn it is (`f32`, m; NaN if it is silent), and the acceleration in the body axes (three `i32`,
//! cm/s²).

use robot_world::Sample;
use semihosting::fs::File;
use semihosting::io::Read;

/// The open stream: an iterator over its samples.
pub(crate) struct Stream {
    file: File,
    time_us: u64,
}

impl Stream {
    pub(crate) fn open() -> Option<Self> {
        Some(Self { file: File::open(c"stream.bin").ok()?, time_us: 0 })
    }
}

impl Iterator for Stream {
    type Item = Sample;

    fn next(&mut self) -> Option<Sample> {
        let mut bytes = [0; 20];
        if self.file.read(&mut bytes).ok()? != bytes.len() {
            return None;
        }
        let (&[elapsed, range, x, y, z], _) = bytes.as_chunks() else { return None };
        self.time_us += u64::from(u32::from_le_bytes(elapsed));
        Some(Sample {
            time_us: self.time_us,
            range: f32::from_le_bytes(range),
            acceleration: [x, y, z].map(|word| i32::from_le_bytes(word) as i16),
        })
    }
}
