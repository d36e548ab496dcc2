//! The first serial port of the machine `mps2-an386`, of Arm's Cortex-M System Design Kit.

use core::convert::Infallible;

use embedded_io::{ErrorType, Write};

use crate::registers::Register;

const BASE: usize = 0x4000_4000;
const DATA: Register = Register::at(BASE);
const STATE: Register = Register::at(BASE + 0x04);
const CONTROL: Register = Register::at(BASE + 0x08);
const DIVIDER: Register = Register::at(BASE + 0x10);

/// A polled serial port, on another machine than [`Uart`](crate::Uart).
pub struct CmsdkUart(());

impl CmsdkUart {
    const TRANSMIT_FULL: u32 = 1;
    const TRANSMIT_ENABLE: u32 = 1;
    /// The smallest divider that the port accepts, for the highest rate; QEMU sends at once.
    const FASTEST: u32 = 16;

    /// Turns on the first port, which QEMU connects to its first `-serial`.
    pub fn first() -> Self {
        DIVIDER.write(Self::FASTEST);
        CONTROL.write(Self::TRANSMIT_ENABLE);
        Self(())
    }
}

impl ErrorType for CmsdkUart {
    type Error = Infallible;
}

impl Write for CmsdkUart {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        for &byte in bytes {
            while STATE.read() & Self::TRANSMIT_FULL != 0 {}
            DATA.write(byte.into());
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while STATE.read() & Self::TRANSMIT_FULL != 0 {}
        Ok(())
    }
}
