//! Simulates an `InvenSense` MPU-9250 on I²C: its accelerometer and gyroscope.

use core::f32::consts::PI;

use embedded_hal::i2c::SevenBitAddress;

use crate::Recording;
use crate::i2c::{Device, Registers, steps};

const GYRO_CONFIG: usize = 0x1B;
const ACCEL_CONFIG: usize = 0x1C;
const INT_ENABLE: usize = 0x38;
const INT_STATUS: usize = 0x3A;
const ACCEL_XOUT_H: usize = 0x3B;
const GYRO_XOUT_H: usize = 0x43;
const WHO_AM_I: usize = 0x75;

const RAW_DATA_READY: u8 = 1;
const STANDARD_GRAVITY: f32 = 9.806_65;

/// A chip that measures what a recording holds: specific force (m/s²) and angular rate (rad/s). Every record is one
/// sample, whatever the configured rate.
pub struct Mpu9250<'a> {
    recording: &'a Recording<6>,
    registers: Registers<128>,
}

impl<'a> Mpu9250<'a> {
    /// The chip after power-on.
    pub const fn new(recording: &'a Recording<6>) -> Self {
        Self { recording, registers: Registers::new() }
    }

    /// Takes a sample with the configured ranges.
    fn sample(&mut self) {
        // 2 g and 250 °/s, doubled by every step of the two bits.
        let accel = 2.0 / 32768.0 * STANDARD_GRAVITY * self.range(ACCEL_CONFIG);
        let gyro = 250.0 / 32768.0 * (PI / 180.0) * self.range(GYRO_CONFIG);
        let [fx, fy, fz, wx, wy, wz] = self.recording.values();
        let measured = [(ACCEL_XOUT_H, [fx, fy, fz], accel), (GYRO_XOUT_H, [wx, wy, wz], gyro)];
        for (first, values, step) in measured {
            let bytes = values.map(|value| steps(value, step).to_be_bytes());
            self.registers.set(first, bytes.as_flattened());
        }
        let ready = self.registers.get(INT_ENABLE) & RAW_DATA_READY;
        self.registers.set(INT_STATUS, &[ready]);
    }

    fn range(&self, register: usize) -> f32 {
        f32::from(1_u8 << (self.registers.get(register) >> 3 & 3))
    }
}

impl Device for Mpu9250<'_> {
    const ADDRESS: SevenBitAddress = 0x68;

    fn write(&mut self, bytes: &[u8]) {
        self.registers.write(bytes);
    }

    fn read(&mut self, bytes: &mut [u8]) {
        if self.recording.take_unread() {
            self.sample();
        }
        self.registers.set(WHO_AM_I, &[0x71]);
        let status_is_read = self.registers.pointer() == INT_STATUS;
        self.registers.read(bytes);
        if status_is_read {
            self.registers.set(INT_STATUS, &[0]);
        }
    }
}
