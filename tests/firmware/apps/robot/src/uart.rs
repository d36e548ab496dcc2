//! The serial port of QEMU's `virt` machine: a 16550.

use core::convert::Infallible;
use core::ptr;

use embedded_io::{ErrorType, Write};

const BASE: usize = 0x1000_0000;
const LINE_STATUS: usize = BASE + 5;
const HOLDING_EMPTY: u8 = 1 << 5;

/// The serial port. QEMU has no baud rate.
pub(crate) struct Uart;

impl ErrorType for Uart {
    type Error = Infallible;
}

impl Write for Uart {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        for &byte in bytes {
            while read(LINE_STATUS) & HOLDING_EMPTY == 0 {}
            #[allow(unsafe_code)] // The transmitter's register, which is empty.
            unsafe {
                ptr::write_volatile(ptr::with_exposed_provenance_mut(BASE), byte);
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

fn read(register: usize) -> u8 {
    #[allow(unsafe_code)] // A register whose reading has no side effect on memory.
    unsafe {
        ptr::read_volatile(ptr::with_exposed_provenance(register))
    }
}
