//! The pin that selects the SD card: bit 0 of port D, Arm's PL061.

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, OutputPin};

use crate::registers::Register;

const BASE: usize = 0x4000_7000;
const BIT: u32 = 1;
/// The port's data register, whose address contains the mask of bits, and its direction register.
const DATA: Register = Register::at(BASE + ((BIT as usize) << 2));
const DIRECTION: Register = Register::at(BASE + 0x400);

/// The select pin: low selects the card (and high the machine's display).
pub struct CardSelect(());

impl CardSelect {
    /// Makes the pin an output, with the card deselected.
    pub fn new() -> Self {
        DATA.write(BIT);
        DIRECTION.write(DIRECTION.read() | BIT);
        Self(())
    }
}

impl Default for CardSelect {
    fn default() -> Self {
        Self::new()
    }
}

impl ErrorType for CardSelect {
    type Error = Infallible;
}

impl OutputPin for CardSelect {
    fn set_low(&mut self) -> Result<(), Infallible> {
        DATA.write(0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        DATA.write(BIT);
        Ok(())
    }
}
