//! The SPI bus of the radio, at 3 MHz, and its chip select.

use core::convert::Infallible;

use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, SpiBus};

use crate::World;
use crate::world::ticks;

/// The duration of a byte, and that of switching the chip select, µs.
const BYTE_US: u64 = 3;
const SELECT_US: u64 = 5;

/// The SPI bus.
///
/// It handles whole transactions: the driver passes each register in one piece, its header first.
#[derive(Debug)]
pub struct Spi<'a>(pub &'a World);

/// The chip select; the bus does not depend on it to find the start of a transaction.
#[derive(Debug)]
pub struct ChipSelect<'a>(pub &'a World);

/// The header of a transaction.
struct Header {
    writes: bool,
    file: u8,
    sub: u16,
    length: usize,
}

impl Header {
    fn of(bytes: &[u8]) -> Option<Self> {
        let &first = bytes.first()?;
        let (mut sub, mut length) = (0, 1);
        if first & 0x40 != 0 {
            let &low = bytes.get(1)?;
            (sub, length) = (u16::from(low & 0x7f), 2);
            if low & 0x80 != 0 {
                sub |= u16::from(*bytes.get(2)?) << 7;
                length = 3;
            }
        }
        Some(Self { writes: first & 0x80 != 0, file: first & 0x3f, sub, length })
    }
}

impl spi::ErrorType for Spi<'_> {
    type Error = Infallible;
}

impl SpiBus for Spi<'_> {
    fn read(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        words.fill(0);
        self.transfer_in_place(words)
    }

    fn write(&mut self, words: &[u8]) -> Result<(), Infallible> {
        self.0.with(|state| {
            state.now += ticks(BYTE_US * words.len() as u64);
            if let Some(header) = Header::of(words).filter(|header| header.writes) {
                let bytes = words.get(header.length..).unwrap_or_default();
                state.radio.write(header.file, header.sub, bytes, state.now, &mut state.anchors);
            }
        });
        Ok(())
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Infallible> {
        for (to, from) in read.iter_mut().zip(write) {
            *to = *from;
        }
        self.transfer_in_place(read)
    }

    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        if Header::of(words).is_some_and(|header| header.writes) {
            return self.write(words);
        }
        self.0.with(|state| {
            state.now += ticks(BYTE_US * words.len() as u64);
            if let Some(header) = Header::of(words) {
                let bytes = words.get_mut(header.length..).unwrap_or_default();
                state.radio.read(header.file, header.sub, bytes, state.now);
            }
        });
        Ok(())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl digital::ErrorType for ChipSelect<'_> {
    type Error = Infallible;
}

impl OutputPin for ChipSelect<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.with(|state| state.now += ticks(SELECT_US));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
