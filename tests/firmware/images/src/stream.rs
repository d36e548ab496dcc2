//! The recorded stream, read record by record from the file `stream.bin` in the emulator's working directory. It is not
//! part of the image, so a new recording needs no new build, is not limited by the flash of a board and does not count
//! as flash.
//!
//! A record is a few words of four bytes, little-endian: microseconds since the previous record (`u32`), then the
//! measurements.

use core::marker::PhantomData;

use semihosting::fd::{AsFd, BorrowedFd};
use semihosting::fs::File;
use semihosting::sys::arm_compat::sys_read_orig;
use support::fail;

const FILE: &core::ffi::CStr = c"stream.bin";
const MOST_WORDS: usize = 7;
const WORD: usize = size_of::<u32>();

/// The measurements at one time.
pub trait Record: Sized {
    /// The number of words of a record, including the time.
    const WORDS: usize;

    /// Creates a record from the microseconds since the start of the stream and the words after the time; `None` if
    /// there are too few of them.
    fn new(time_us: u64, words: &[[u8; WORD]]) -> Option<Self>;
}

/// A sample of an inertial sensor, in its own axes: three `f32` and three `f32`.
#[derive(Clone, Copy)]
pub struct Sample {
    /// The time since the start of the stream, µs; the first sample may be later than 0.
    pub time_us: u64,
    /// Specific force, m/s²: +1 g upwards at rest.
    pub specific_force: [f32; 3],
    /// Angular rate, rad/s.
    pub angular_rate: [f32; 3],
}

impl Record for Sample {
    const WORDS: usize = 7;

    fn new(time_us: u64, words: &[[u8; WORD]]) -> Option<Self> {
        let &[fx, fy, fz, wx, wy, wz] = words.as_array()?;
        Some(Self {
            time_us,
            specific_force: [fx, fy, fz].map(f32::from_le_bytes),
            angular_rate: [wx, wy, wz].map(f32::from_le_bytes),
        })
    }
}

/// A range to one of several anchors: a `u32` and an `f32`.
#[derive(Clone, Copy)]
pub struct Range {
    /// The time since the start of the stream, µs.
    pub time_us: u64,
    /// The number of the anchor.
    pub anchor: u32,
    /// The range, m.
    pub range: f32,
}

impl Record for Range {
    const WORDS: usize = 3;

    fn new(time_us: u64, words: &[[u8; WORD]]) -> Option<Self> {
        let &[anchor, range] = words.as_array()?;
        Some(Self { time_us, anchor: u32::from_le_bytes(anchor), range: f32::from_le_bytes(range) })
    }
}

/// Ranges to four anchors at once: four `f32`.
#[derive(Clone, Copy)]
pub struct Ranges {
    /// The ranges, m.
    pub ranges: [f32; 4],
}

impl Record for Ranges {
    const WORDS: usize = 5;

    fn new(_: u64, words: &[[u8; WORD]]) -> Option<Self> {
        let &words: &[[u8; WORD]; 4] = words.as_array()?;
        Some(Self { ranges: words.map(f32::from_le_bytes) })
    }
}

/// A path loss measured by a drone: four `f32`.
#[derive(Clone, Copy)]
pub struct PathLoss {
    /// The horizontal position of the drone, m.
    pub place: [f32; 2],
    /// The height of the drone, m.
    pub height: f32,
    /// The path loss, dB.
    pub loss: f32,
}

impl Record for PathLoss {
    const WORDS: usize = 5;

    fn new(_: u64, words: &[[u8; WORD]]) -> Option<Self> {
        let &words: &[[u8; WORD]; 4] = words.as_array()?;
        let [x, y, height, loss] = words.map(f32::from_le_bytes);
        Some(Self { place: [x, y], height, loss })
    }
}

/// A moment of a flight: two `f32` and three `f32`.
#[derive(Clone, Copy)]
pub struct Flight {
    /// Elevator (rad) and throttle.
    pub inputs: [f32; 2],
    /// Pitch rate (rad/s), airspeed (m/s) and pitch (rad).
    pub outputs: [f32; 3],
}

impl Record for Flight {
    const WORDS: usize = 6;

    fn new(_: u64, words: &[[u8; WORD]]) -> Option<Self> {
        let &[elevator, throttle, rate, airspeed, pitch] = words.as_array()?;
        Some(Self {
            inputs: [elevator, throttle].map(f32::from_le_bytes),
            outputs: [rate, airspeed, pitch].map(f32::from_le_bytes),
        })
    }
}

/// Opens the file of a stream; ends the image with a failure if there is none.
pub fn open() -> File {
    match File::open(FILE) {
        Ok(file) => file,
        Err(_) => fail("no stream.bin"),
    }
}

/// The open stream: an iterator over its records and their times.
pub struct Stream<'a, R> {
    /// Not the file: borrowing from that asserts, at every record, that it is open.
    file: BorrowedFd<'a>,
    time_us: u64,
    record: PhantomData<R>,
}

impl<'a, R: Record> Stream<'a, R> {
    /// The records of the file that [`open`] returned.
    #[inline(always)] // Where the file was just opened, the assertion is none.
    pub fn of(file: &'a File) -> Self {
        Self { file: file.as_fd(), time_us: 0, record: PhantomData }
    }
}

impl<R: Record> Iterator for Stream<'_, R> {
    type Item = (u64, R);

    fn next(&mut self) -> Option<(u64, R)> {
        let mut bytes = [0; MOST_WORDS * WORD];
        let bytes = bytes.get_mut(..R::WORDS * WORD)?;
        // The call returns the number of missing bytes.
        match sys_read_orig(self.file, bytes) {
            Ok(0) => {}
            Ok(missing) if missing == bytes.len() => return None,
            _ => fail("stream.bin is cut in the middle of a record"),
        }
        let (words, _) = bytes.as_chunks();
        let (&elapsed, words) = words.split_first()?;
        self.time_us += u64::from(u32::from_le_bytes(elapsed));
        Some((self.time_us, R::new(self.time_us, words)?))
    }
}
