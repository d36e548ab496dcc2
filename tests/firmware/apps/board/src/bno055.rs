//! Simulates a Bosch BNO055 on I²C: its pitch rate and pitch angle.

use core::f32::consts::PI;

use embedded_hal::i2c::SevenBitAddress;

use crate::Recording;
use crate::i2c::{Device, Registers, steps};

const CHIP_ID: usize = 0x00;
const GYR_DATA_Y: usize = 0x16;
const EUL_PITCH: usize = 0x1E;
const SYS_TRIGGER: usize = 0x3F;
const RESET: u8 = 0x20;
const OPR_MODE: usize = 0x3D;
const NDOF: u8 = 0x0C;

/// A sixteenth of a degree, rad.
const STEP: f32 = PI / 180.0 / 16.0;

/// A chip that measures what a recording of a flight holds: its third and fifth number, pitch rate (rad/s) and pitch
/// (rad). Its y axis is the aeroplane's.
pub struct Bno055<'a> {
    recording: &'a Recording<5>,
    registers: Registers<128>,
}

impl<'a> Bno055<'a> {
    /// The chip after power-on.
    pub const fn new(recording: &'a Recording<5>) -> Self {
        Self { recording, registers: Registers::new() }
    }
}

impl Device for Bno055<'_> {
    const ADDRESS: SevenBitAddress = 0x29;

    fn write(&mut self, bytes: &[u8]) {
        self.registers.write(bytes);
        if self.registers.get(SYS_TRIGGER) & RESET != 0 {
            self.registers = Registers::new();
        }
    }

    fn read(&mut self, bytes: &mut [u8]) {
        self.registers.set(CHIP_ID, &[0xA0]);
        // Only the fusion mode yields a pitch.
        if self.registers.get(OPR_MODE) == NDOF {
            let [_, _, rate, _, pitch] = self.recording.values();
            self.registers.set(GYR_DATA_Y, &steps(rate, STEP).to_le_bytes());
            self.registers.set(EUL_PITCH, &steps(pitch, STEP).to_le_bytes());
        }
        self.registers.read(bytes);
    }
}
