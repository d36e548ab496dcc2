//! The input of serial ports: a recording, which also provides the time.
//!
//! It is the file `stream.bin` in the emulator's working directory: each record has the microseconds since the previous
//! record (`u32`), the port (`u16`), a count (`u16`), all little-endian, and that many bytes.

use core::cell::{Cell, RefCell};
use core::convert::Infallible;

use embedded_io::{ErrorType, Read, ReadReady};
use heapless::Deque;
use semihosting::fs::File;
use semihosting::io::Read as _;

use crate::system::fail;

const FILE: &core::ffi::CStr = c"stream.bin";
/// The number of bytes that a port buffers; further ones are lost, as on any port.
const CAPACITY: usize = 512;

/// A recording of `N` ports, which is also the only clock.
pub struct Tape<const N: usize> {
    file: RefCell<File>,
    time_us: Cell<u64>,
    ports: [RefCell<Deque<u8, CAPACITY>>; N],
}

/// A receive-only port.
pub struct Port<'a>(&'a RefCell<Deque<u8, CAPACITY>>);

impl<const N: usize> Tape<N> {
    /// Opens the recording, before its first record; ends the emulation as a failure if there is none.
    pub fn open() -> Self {
        let Ok(file) = File::open(FILE) else { fail() };
        let ports = [const { RefCell::new(Deque::new()) }; N];
        Self { file: RefCell::new(file), time_us: Cell::new(0), ports }
    }

    /// The ports, in the recording's order.
    pub fn ports(&self) -> [Port<'_>; N] {
        self.ports.each_ref().map(Port)
    }

    /// Advances to the next record; `false` at the end, when the device is switched off.
    pub fn wait(&self) -> bool {
        let mut head = [0; 8];
        if !self.fill(&mut head) {
            return false;
        }
        let [elapsed @ .., p, q, c, d] = head;
        self.time_us.set(self.time_us.get() + u64::from(u32::from_le_bytes(elapsed)));
        let Some(port) = self.ports.get(usize::from(u16::from_le_bytes([p, q]))) else { fail() };
        let Ok(mut port) = port.try_borrow_mut() else { fail() };
        for _ in 0..u16::from_le_bytes([c, d]) {
            let mut byte = [0];
            if !self.fill(&mut byte) {
                fail();
            }
            let [byte] = byte;
            let _ = port.push_back(byte);
        }
        true
    }

    /// The time since the start of the recording, µs.
    pub fn time_us(&self) -> u64 {
        self.time_us.get()
    }

    /// Fills `bytes` from the file; `false` at the end.
    fn fill(&self, bytes: &mut [u8]) -> bool {
        let Ok(mut file) = self.file.try_borrow_mut() else { fail() };
        match file.read(bytes) {
            Ok(0) => false,
            Ok(count) if count == bytes.len() => true,
            _ => fail(),
        }
    }
}

impl ErrorType for Port<'_> {
    type Error = Infallible;
}

impl ReadReady for Port<'_> {
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.try_borrow().is_ok_and(|port| !port.is_empty()))
    }
}

impl Read for Port<'_> {
    /// Reads what is buffered and may return 0, where real hardware would wait for the first byte: use [`ReadReady`].
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        let Ok(mut port) = self.0.try_borrow_mut() else { return Ok(0) };
        let mut count = 0;
        for byte in bytes {
            let Some(next) = port.pop_front() else { break };
            *byte = next;
            count += 1;
        }
        Ok(count)
    }
}
