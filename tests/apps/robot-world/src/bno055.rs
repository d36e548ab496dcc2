//! Simulates the accelerometer of a BNO055: page 0 of its registers.

use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};

use crate::World;
use crate::world::ticks;

const ADDRESS: u8 = 0x29;
const CHIP_ID: u8 = 0x00;
const ACC_DATA: u8 = 0x08;
const OPR_MODE: u8 = 0x3d;
const SYS_TRIGGER: u8 = 0x3f;
const ACC_ONLY: u8 = 0x01;
const RESET: u8 = 0x20;
/// The time from a reset to the first acknowledge, µs (data sheet, table 0-2).
const STARTS_IN_US: u64 = 650_000;

/// The chip.
#[derive(Debug)]
pub(crate) struct Bno055 {
    /// The acceleration, cm/s².
    pub(crate) acceleration: [i16; 3],
    registers: [u8; 128],
    register: u8,
    /// The time until which it does not answer.
    ready: u64,
}

impl Bno055 {
    pub(crate) const fn new() -> Self {
        Self { acceleration: [0; 3], registers: [0; 128], register: 0, ready: 0 }
    }

    fn write(&mut self, bytes: &[u8], now: u64) {
        let Some((&register, values)) = bytes.split_first() else { return };
        self.register = register;
        for &value in values {
            if self.register == SYS_TRIGGER && value & RESET != 0 {
                self.registers = [0; 128];
                self.ready = now + ticks(STARTS_IN_US);
            } else if let Some(byte) = self.registers.get_mut(usize::from(self.register)) {
                *byte = value;
            }
            self.register = self.register.wrapping_add(1);
        }
    }

    fn read(&mut self) -> u8 {
        let register = self.register;
        self.register = register.wrapping_add(1);
        if register == CHIP_ID {
            return 0xa0;
        }
        let measures = self.registers.get(usize::from(OPR_MODE)) == Some(&ACC_ONLY);
        let place = usize::from(register.wrapping_sub(ACC_DATA));
        if let Some(count) = self.acceleration.get(place / 2) {
            let [low, high] = if measures { count.to_le_bytes() } else { [0; 2] };
            return if place % 2 == 0 { low } else { high };
        }
        self.registers.get(usize::from(register)).copied().unwrap_or_default()
    }
}

/// The I²C bus of the chip.
#[derive(Debug)]
pub struct I2cBus<'a>(pub &'a World);

impl ErrorType for I2cBus<'_> {
    type Error = ErrorKind;
}

impl I2c for I2cBus<'_> {
    fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), ErrorKind> {
        let done = self.0.with(|state| {
            if address != ADDRESS || state.now < state.imu.ready {
                return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
            }
            for operation in operations {
                match operation {
                    Operation::Write(bytes) => state.imu.write(bytes, state.now),
                    Operation::Read(bytes) => bytes.fill_with(|| state.imu.read()),
                }
            }
            Ok(())
        });
        done.unwrap_or(Err(ErrorKind::Other))
    }
}
