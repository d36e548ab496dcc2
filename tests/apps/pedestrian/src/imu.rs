//! The sensor: its settings, and the scale of its counts.

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use embedded_hal_02::blocking::delay::DelayMs;
use embedded_hal_compat::{Reverse, ReverseCompat};
use mpu9250::{
    AccelDataRate, AccelScale, Dlpf, GyroScale, GyroTempDataRate, I2CError, I2cDevice,
    InterruptEnable, Mpu9250, MpuConfig,
};

/// Standard gravity, m/s².
const STANDARD_GRAVITY: f32 = 9.806_65;

/// A reading in the sensor's counts: 2048 per g, and 2048 per 125 °/s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts {
    /// Specific force in the sensor's axes.
    pub accel: [i16; 3],
    /// Angular rate in the sensor's axes.
    pub gyro: [i16; 3],
}

impl Counts {
    /// The number of counts per unit of either sensor.
    pub(crate) const PER_UNIT: i32 = 2048;
    /// The unit of the gyroscope, °/s; that of the accelerometer is 1 g.
    pub(crate) const GYRO_UNIT: i32 = 125;

    /// The specific force, m/s².
    pub fn specific_force(&self) -> [f32; 3] {
        self.accel.map(|count| f32::from(count) * (STANDARD_GRAVITY / Self::PER_UNIT as f32))
    }

    /// The angular rate, rad/s.
    pub fn angular_rate(&self) -> [f32; 3] {
        const STEP: f32 = (Counts::GYRO_UNIT as f32).to_radians() / Counts::PER_UNIT as f32;
        self.gyro.map(|count| f32::from(count) * STEP)
    }
}

/// Why a reading failed; `E` is the bus' error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SensorError<E> {
    /// The bus failed.
    Bus(E),
    /// Another chip answered, with this `WHO_AM_I`.
    WrongChip(u8),
    /// The driver gave up.
    Driver,
}

impl<E> From<I2CError<E>> for SensorError<E> {
    fn from(error: I2CError<E>) -> Self {
        match error {
            I2CError::BusError(error) => Self::Bus(error),
            I2CError::WriteManyError => Self::Driver,
        }
    }
}

impl<E> From<mpu9250::Error<I2CError<E>>> for SensorError<E> {
    fn from(error: mpu9250::Error<I2CError<E>>) -> Self {
        match error {
            mpu9250::Error::BusError(error) => error.into(),
            mpu9250::Error::InvalidDevice(who) | mpu9250::Error::ModeNotSupported(who) => {
                Self::WrongChip(who)
            }
            _ => Self::Driver,
        }
    }
}

/// An MPU-9250 on I²C: 16 g and 2000 °/s, because a foot strikes; 100 samples a second.
pub struct Imu<I2C> {
    driver: Mpu9250<I2cDevice<Reverse<I2C>>, mpu9250::Imu>,
}

impl<I2C: I2c> Imu<I2C> {
    /// Sets the sensor up.
    ///
    /// # Errors
    /// [`SensorError`].
    pub fn new(i2c: I2C, delay: &mut impl DelayNs) -> Result<Self, SensorError<I2C::Error>> {
        let mut config = MpuConfig::imu();
        config
            .accel_scale(AccelScale::_16G)
            .gyro_scale(GyroScale::_2000DPS)
            .accel_data_rate(AccelDataRate::DlpfConf(Dlpf::_3))
            .gyro_temp_data_rate(GyroTempDataRate::DlpfConf(Dlpf::_3))
            // 1 kHz divided by ten.
            .sample_rate_divisor(9);
        let mut driver = Mpu9250::imu(i2c.reverse(), &mut Milliseconds(delay), &mut config)?;
        driver.enable_interrupts(InterruptEnable::RAW_RDY_EN)?;
        Ok(Self { driver })
    }

    /// The reading that has not been fetched yet, if there is one.
    ///
    /// # Errors
    /// [`SensorError`].
    pub fn read(&mut self) -> Result<Option<Counts>, SensorError<I2C::Error>> {
        if !self.driver.get_interrupt_status()?.contains(InterruptEnable::RAW_RDY_EN) {
            return Ok(None);
        }
        let counts = self.driver.unscaled_all::<[i16; 3]>()?;
        Ok(Some(Counts { accel: counts.accel, gyro: counts.gyro }))
    }
}

/// Adapts a delay to the driver's type; `embedded-hal-compat` only supports longer integers.
struct Milliseconds<'a, D>(&'a mut D);

impl<D: DelayNs> DelayMs<u8> for Milliseconds<'_, D> {
    fn delay_ms(&mut self, milliseconds: u8) {
        self.0.delay_ms(milliseconds.into());
    }
}
