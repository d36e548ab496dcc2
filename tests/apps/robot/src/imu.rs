//! A BNO055 used as an accelerometer.

use bno055::{BNO055OperationMode, Bno055, Error};
use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use kestirim_scalar::Scalar;
use nalgebra::Vector3;

use crate::Number;

/// The reason why there is no acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ImuError {
    /// The bus failed, or no chip answered.
    Bus,
    /// The chip that answered is not a BNO055.
    NotABno055,
}

/// A BNO055 at its first address, 0x29.
pub struct Imu<I> {
    driver: Bno055<I>,
}

impl<I: I2c> Imu<I> {
    /// Resets the chip and turns on the accelerometer alone, in its range of ±4 g.
    ///
    /// # Errors
    /// Any [`ImuError`].
    pub fn new(bus: I, delay: &mut impl DelayNs) -> Result<Self, ImuError> {
        let mut driver = Bno055::new(bus);
        driver.init(delay).map_err(|error| why(&error))?;
        driver.set_mode(BNO055OperationMode::ACC_ONLY, delay).map_err(|error| why(&error))?;
        Ok(Self { driver })
    }

    /// The reading of the accelerometer in the chip's axes, including gravity, m/s².
    ///
    /// # Errors
    /// Any [`ImuError`].
    pub fn acceleration(&mut self) -> Result<Vector3<Number>, ImuError> {
        let raw = self.driver.accel_data_fixed().map_err(|error| why(&error))?;
        // 1 cm/s² per count, converted to the tracker's number without floating point.
        Ok(Vector3::new(raw.x, raw.y, raw.z)
            .map(|count| Number::from_micro(i32::from(count) * 10_000)))
    }
}

fn why<E>(error: &Error<E>) -> ImuError {
    match error {
        Error::I2c(_) => ImuError::Bus,
        _ => ImuError::NotABno055,
    }
}
