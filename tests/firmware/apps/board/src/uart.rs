//! The first serial port: Arm's PL011.

use core::convert::Infallible;

use embedded_io::{ErrorType, Write};

use crate::registers::Register;

const BASE: usize = 0x4000_C000;
const DATA: Register = Register::at(BASE);
const FLAGS: Register = Register::at(BASE + 0x18);
const CONTROL: Register = Register::at(BASE + 0x30);

/// A serial port. QEMU has no baud rate.
pub struct Uart(());

impl Uart {
    const TRANSMIT_FULL: u32 = 1 << 5;
    const TRANSMIT_EMPTY: u32 = 1 << 7;
    /// The enable bits of the port and its transmitter.
    const ENABLE: u32 = 1 | 1 << 8;

    /// Turns on the first port, which QEMU connects to its first `-serial`.
    pub fn first() -> Self {
        CONTROL.write(Self::ENABLE);
        Self(())
    }
}

impl ErrorType for Uart {
    type Error = Infallible;
}

impl Write for Uart {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        for &byte in bytes {
            while FLAGS.read() & Self::TRANSMIT_FULL != 0 {}
            DATA.write(byte.into());
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while FLAGS.read() & Self::TRANSMIT_EMPTY == 0 {}
        Ok(())
    }
}
