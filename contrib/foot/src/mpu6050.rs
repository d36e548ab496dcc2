//! An MPU-6050 (the maker's register map, revision 4.2).

use embedded_hal_async::i2c::I2c;

const ADDRESS: u8 = 0x68;
const SAMPLE_RATE_DIVIDER: u8 = 0x19;
/// Divider, low-pass filter, range of the gyroscope, range of the accelerometer: four registers in a row.
const SETTINGS: u8 = SAMPLE_RATE_DIVIDER;
const INTERRUPT_ENABLE: u8 = 0x38;
const MEASUREMENTS: u8 = 0x3B;
const POWER: u8 = 0x6B;
const WHO_AM_I: u8 = 0x75;

/// With the low-pass filter on, a thousand samples a second are divided.
const UNDIVIDED: u32 = 1000;
/// 44 Hz, below half of 100 samples a second: what a heel strike shakes beyond that would fold into the motion.
const LOW_PASS: u8 = 3;
/// ±2000 °/s: heel strikes reach 600 and more.
const GYROSCOPE: u8 = 3 << 3;
/// ±16 g: heel strikes reach 8.
const ACCELEROMETER: u8 = 3 << 3;
const METRES_PER_SQUARE_SECOND: f32 = 9.806_65 / 2048.0;
const RADIANS_PER_SECOND: f32 = core::f32::consts::PI / 180.0 / 16.4;

/// Why there is no sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Error<E> {
    /// The bus's.
    Bus(E),
    /// Another chip answers.
    NotThere,
    /// No sensor can have measured that, or it came out of order.
    Refused(kestirim_pedestrian::Error),
}

impl<E> From<E> for Error<E> {
    fn from(error: E) -> Self {
        Self::Bus(error)
    }
}

/// The sensor.
pub struct Mpu6050<B>(B);

impl<B: I2c> Mpu6050<B> {
    /// Wakes the sensor and sets it up for so many samples a second (4 to 1000).
    ///
    /// # Errors
    /// The bus's, or [`Error::NotThere`].
    pub async fn new(mut bus: B, rate: u32) -> Result<Self, Error<B::Error>> {
        let mut answer = [0];
        bus.write_read(ADDRESS, &[WHO_AM_I], &mut answer).await?;
        if answer != [ADDRESS] {
            return Err(Error::NotThere);
        }
        // The gyroscope's oscillator is the steadier clock.
        bus.write(ADDRESS, &[POWER, 1]).await?;
        let divider = (UNDIVIDED / rate.clamp(4, UNDIVIDED) - 1) as u8;
        let settings = [SETTINGS, divider, LOW_PASS, GYROSCOPE, ACCELEROMETER];
        bus.write(ADDRESS, &settings).await?;
        bus.write(ADDRESS, &[INTERRUPT_ENABLE, 1]).await?;
        Ok(Self(bus))
    }

    /// Specific force (m/s²) and angular rate (rad/s), in the chip's axes.
    ///
    /// # Errors
    /// The bus's.
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
