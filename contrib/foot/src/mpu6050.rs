//! Driver of the MPU-6050, by the manufacturer's register map, revision 4.2.

use embedded_hal_async::i2c::I2c;

const ADDRESS: u8 = 0x68;
const SAMPLE_RATE_DIVIDER: u8 = 0x19;
/// The first of four consecutive registers: sample rate divider, low-pass filter, gyroscope range, accelerometer range.
const SETTINGS: u8 = SAMPLE_RATE_DIVIDER;
const INTERRUPT_ENABLE: u8 = 0x38;
const MEASUREMENTS: u8 = 0x3B;
const POWER: u8 = 0x6B;
const WHO_AM_I: u8 = 0x75;

/// The sample rate before the divider with the low-pass filter on, Hz.
const UNDIVIDED: u32 = 1000;
/// The low-pass filter at 44 Hz, below half of 100 samples per second: the faster vibration of a heel strike would be
/// aliased into the motion.
const LOW_PASS: u8 = 3;
/// The range of the gyroscope, ±2000 °/s: heel strikes reach 600 °/s and more.
const GYROSCOPE: u8 = 3 << 3;
/// The range of the accelerometer, ±16 g: heel strikes reach 8 g.
const ACCELEROMETER: u8 = 3 << 3;
const METRES_PER_SQUARE_SECOND: f32 = 9.806_65 / 2048.0;
const RADIANS_PER_SECOND: f32 = core::f32::consts::PI / 180.0 / 16.4;

/// The reason why a sensor was not set up, or a sample not processed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Error<E> {
    /// An error of the bus.
    Bus(E),
    /// The chip at the address is not an MPU-6050.
    NotThere,
    /// The tracker refused the sample: no sensor can have measured it, or it is out of order.
    Refused(kestirim_pedestrian::Error),
}

impl<E> From<E> for Error<E> {
    fn from(error: E) -> Self {
        Self::Bus(error)
    }
}

/// An MPU-6050 on an I²C bus.
pub struct Mpu6050<B>(B);

impl<B: I2c> Mpu6050<B> {
    /// Wakes the sensor and sets it up for `rate` samples per second (4 to 1000).
    ///
    /// # Errors
    /// [`Error::Bus`] or [`Error::NotThere`].
    pub async fn new(mut bus: B, rate: u32) -> Result<Self, Error<B::Error>> {
        let mut answer = [0];
        bus.write_read(ADDRESS, &[WHO_AM_I], &mut answer).await?;
        if answer != [ADDRESS] {
            return Err(Error::NotThere);
        }
        // The gyroscope's oscillator is a more stable clock than the internal one.
        bus.write(ADDRESS, &[POWER, 1]).await?;
        let divider = (UNDIVIDED / rate.clamp(4, UNDIVIDED) - 1) as u8;
        let settings = [SETTINGS, divider, LOW_PASS, GYROSCOPE, ACCELEROMETER];
        bus.write(ADDRESS, &settings).await?;
        bus.write(ADDRESS, &[INTERRUPT_ENABLE, 1]).await?;
        Ok(Self(bus))
    }

    /// Reads specific force (m/s²) and angular rate (rad/s), in the chip's axes.
    ///
    /// # Errors
    /// [`Error::Bus`].
    pub async fn read(&mut self) -> Result<([f32; 3], [f32; 3]), Error<B::Error>> {
        let mut bytes = [0; 14];
        self.0.write_read(ADDRESS, &[MEASUREMENTS], &mut bytes).await?;
        let (words, _) = bytes.as_chunks();
        let &[ax, ay, az, _temperature, gx, gy, gz] = words else { return Err(Error::NotThere) };
        let count = |word| f32::from(i16::from_be_bytes(word));
        Ok((
            [ax, ay, az].map(|word| count(word) * METRES_PER_SQUARE_SECOND),
            [gx, gy, gz].map(|word| count(word) * RADIANS_PER_SECOND),
        ))
    }
}
