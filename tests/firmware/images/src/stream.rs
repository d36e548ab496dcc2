//! The recorded stream, read sample by sample from the file `stream.bin` in the emulator's working
//! directory. It is not part of the image, so a new recording needs no new build, is not limited by
//! the flash of a board and does not count as flash.
//!
//! Twenty-eight bytes a sample, little-endian: microseconds since the previous sample (`u32`),
//! specific force in m/s² (three `f32`), angular rate in rad/s (three `f32`).

use semihosting::fs::File;
use semihosting::io::Read;
use support::fail;

const FILE: &core::ffi::CStr = c"stream.bin";
const WORDS: usize = 7;
const BYTES: usize = WORDS * size_of::<u32>();

/// A sample of an inertial sensor, in its own axes.
#[derive(Clone, Copy)]
pub struct Sample {
    /// Microseconds since the start of the stream; the first sample may be later than 0.
    pub time_us: u64,
    /// m/s²; at rest +1 g upwards.
    pub specific_force: [f32; 3],
    /// rad/s.
    pub angular_rate: [f32; 3],
}

/// The open stream: an iterator over its samples.
pub struct Stream {
    file: File,
    time_us: u64,
}

impl Stream {
    /// Opens the stream; fails the image if there is none.
    pub fn open() -> Self {
        match File::open(FILE) {
            Ok(file) => Self { file, time_us: 0 },
            Err(_) => fail("no stream.bin"),
        }
    }
}

impl Iterator for Stream {
    type Item = Sample;

    fn next(&mut self) -> Option<Sample> {
        let mut record = [0; BYTES];
        match self.file.read(&mut record) {
            Ok(0) => return None,
            Ok(BYTES) => {}
            _ => fail("stream.bin is cut in the middle of a sample"),
        }
        let (words, _) = record.as_chunks();
        let &[elapsed, fx, fy, fz, wx, wy, wz] = words.as_array::<WORDS>()?;
        self.time_us += u64::from(u32::from_le_bytes(elapsed));
        Some(Sample {
            time_us: self.time_us,
            specific_force: [fx, fy, fz].map(f32::from_le_bytes),
            angular_rate: [wx, wy, wz].map(f32::from_le_bytes),
        })
    }
}
