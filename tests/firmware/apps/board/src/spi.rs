//! The serial bus that the SD card is on: Arm's PL022.

use core::convert::Infallible;

use embedded_hal::spi::{ErrorType, SpiBus};

use crate::registers::Register;

const BASE: usize = 0x4000_8000;
const CONTROL_0: Register = Register::at(BASE);
const CONTROL_1: Register = Register::at(BASE + 0x04);
const DATA: Register = Register::at(BASE + 0x08);
const STATUS: Register = Register::at(BASE + 0x0C);
const PRESCALE: Register = Register::at(BASE + 0x10);

/// Eight bits, mode 0.
const EIGHT_BITS: u32 = 7;
const ENABLE: u32 = 1 << 1;
const RECEIVED: u32 = 1 << 2;

/// A bus master.
pub struct Spi(());

impl Spi {
    /// Turns on the bus.
    pub fn new() -> Self {
        PRESCALE.write(2);
        CONTROL_0.write(EIGHT_BITS);
        CONTROL_1.write(ENABLE);
        Self(())
    }

    fn exchange(byte: u8) -> u8 {
        DATA.write(byte.into());
        while STATUS.read() & RECEIVED == 0 {}
        DATA.read() as u8
    }
}

impl Default for Spi {
    fn default() -> Self {
        Self::new()
    }
}

impl ErrorType for Spi {
    type Error = Infallible;
}

impl SpiBus for Spi {
    fn read(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        words.fill_with(|| Self::exchange(0xFF));
        Ok(())
    }

    fn write(&mut self, words: &[u8]) -> Result<(), Infallible> {
        for &word in words {
            Self::exchange(word);
        }
        Ok(())
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Infallible> {
        for index in 0..read.len().max(write.len()) {
            let received = Self::exchange(write.get(index).copied().unwrap_or(0xFF));
            if let Some(word) = read.get_mut(index) {
                *word = received;
            }
        }
        Ok(())
    }

    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        for word in words {
            *word = Self::exchange(*word);
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
