//! The serial bus with the SD card: Arm's PL022.

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

/// The first byte of the command `READ_OCR`, CMD58, on the bus.
const READ_OCR: u8 = 0x40 | 58;
/// The token that precedes the data of a block to be written.
const DATA_TOKEN: u8 = 0xFE;
/// The flag for a card that is not ready, in the first byte of its answer.
const IDLE: u8 = 1;

/// A bus master.
pub struct Spi {
    /// Whether the answer to `READ_OCR` is pending.
    reads_ocr: bool,
}

impl Spi {
    /// Turns on the bus.
    pub fn new() -> Self {
        PRESCALE.write(2);
        CONTROL_0.write(EIGHT_BITS);
        CONTROL_1.write(ENABLE);
        Self { reads_ocr: false }
    }

    /// Exchanges a byte, and works around a bug: QEMU 7.2 always answers `READ_OCR` as if the card were idle. A card
    /// that has become ready does not, and the driver would take it for broken; that one bit is corrected here.
    fn exchange(&mut self, byte: u8) -> u8 {
        DATA.write(byte.into());
        while STATUS.read() & RECEIVED == 0 {}
        let received = DATA.read() as u8;
        if self.reads_ocr && received < 0x80 {
            self.reads_ocr = false;
            return received & !IDLE;
        }
        received
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
        words.fill_with(|| self.exchange(0xFF));
        Ok(())
    }

    fn write(&mut self, words: &[u8]) -> Result<(), Infallible> {
        for &word in words {
            self.exchange(word);
        }
        // A command has six bytes.
        self.reads_ocr = matches!(words, [READ_OCR, _, _, _, _, _]);
        Ok(())
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Infallible> {
        // The standard requires a pause of at least one byte between a card's answer and data (N_WR). The driver leaves
        // it out, which many cards tolerate and QEMU does not.
        if write == [DATA_TOKEN] {
            self.exchange(0xFF);
        }
        for index in 0..read.len().max(write.len()) {
            let received = self.exchange(write.get(index).copied().unwrap_or(0xFF));
            if let Some(word) = read.get_mut(index) {
                *word = received;
            }
        }
        Ok(())
    }

    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        for word in words {
            *word = self.exchange(*word);
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
