//! The sensors' measurements: a recording, which also provides the time.
//!
//! It is the file `stream.bin` in the emulator's working directory: records of a few words of four bytes,
//! little-endian. The first is the microseconds since the previous record (`u32`), the others are the measurements
//! (`f32`).

use core::cell::{Cell, RefCell};

use semihosting::fs::File;
use semihosting::io::Read;

use crate::system::fail;

const FILE: &core::ffi::CStr = c"stream.bin";
const WORD: usize = size_of::<u32>();
const MOST_WORDS: usize = 8;

/// A recording with `N` numbers per record, which is also the only clock.
pub struct Recording<const N: usize> {
    file: RefCell<File>,
    time_us: Cell<u64>,
    values: Cell<[f32; N]>,
    unread: Cell<bool>,
}

impl<const N: usize> Recording<N> {
    /// Opens the recording, before its first record; ends the emulation as a failure if there is none.
    pub fn open() -> Self {
        const { assert!(N < MOST_WORDS) };
        let Ok(file) = File::open(FILE) else { fail() };
        Self {
            file: RefCell::new(file),
            time_us: Cell::new(0),
            values: Cell::new([0.0; N]),
            unread: Cell::new(false),
        }
    }

    /// Advances to the next record; `false` at the end, when the device is switched off.
    pub fn wait(&self) -> bool {
        let mut bytes = [0; MOST_WORDS * WORD];
        let Some(bytes) = bytes.get_mut(..(N + 1) * WORD) else { fail() };
        let Ok(mut file) = self.file.try_borrow_mut() else { fail() };
        match file.read(bytes) {
            Ok(0) => return false,
            Ok(count) if count == bytes.len() => {}
            _ => fail(),
        }
        let (words, _) = bytes.as_chunks();
        let Some((&elapsed, words)) = words.split_first() else { fail() };
        self.time_us.set(self.time_us.get() + u64::from(u32::from_le_bytes(elapsed)));
        let Some(words) = words.as_array::<N>() else { fail() };
        self.values.set(words.map(f32::from_le_bytes));
        self.unread.set(true);
        true
    }

    /// The time since the start of the recording, µs.
    pub fn time_us(&self) -> u64 {
        self.time_us.get()
    }

    /// The values of the current record.
    pub fn values(&self) -> [f32; N] {
        self.values.get()
    }

    /// Whether the current record has not been read yet; `true` once per record.
    pub(crate) fn take_unread(&self) -> bool {
        self.unread.take()
    }
}
