//! The serial ports: Arm's PL011.

use core::convert::Infallible;

use embedded_io::{ErrorType, Write};

use crate::registers::Register;

/// A serial port. QEMU knows no baud rate.
pub struct Uart {
    data: Register,
    flags: Register,
}

impl Uart {
    const TRANSMIT_FULL: u32 = 1 << 5;
    const TRANSMIT_EMPTY: u32 = 1 << 7;
    /// The port, and its transmitter.
    const ENABLE: u32 = 1 | 1 << 8;

    /// Turns on the first port, which QEMU's first `-serial` is connected to.
    pub fn first() -> Self {
        Self::at::<0x4000_C000>()
    }

    /// Turns on the second port, which QEMU's second `-serial` is connected to.
    pub fn second() -> Self {
        Self::at::<0x4000_D000>()
    }

    fn at<const BASE: usize>() -> Self {
        const { Register::at(BASE + 0x30) }.write(Self::ENABLE);
        Self { data: const { Register::at(BASE) }, flags: const { Register::at(BASE + 0x18) } }
    }
}

impl ErrorType for Uart {
    type Error = Infallible;
}

impl Write for Uart {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        for &byte in bytes {
            while self.flags.read() & Self::TRANSMIT_FULL != 0 {}
            self.data.write(byte.into());
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while self.flags.read() & Self::TRANSMIT_EMPTY == 0 {}
        Ok(())
    }
}
