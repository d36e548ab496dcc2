//! A foot-mounted MPU-6050 and its tracker, for any board with async I²C: a board's program waits for the sensor's
//! interrupt and calls [`Foot::step`].
#![no_std]

mod mpu6050;

use embedded_hal_async::i2c::I2c;
use kestirim_health::Health;
use kestirim_pedestrian::{Config, EkfTracker, ImuSample, PathUncertainty, SensorClass};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

use mpu6050::Mpu6050;

pub use mpu6050::Error;

/// The tracker's number: for a processor without a floating-point unit, fixed point.
#[cfg(feature = "fixed")]
pub type Number = kestirim_scalar::Q12_20;
/// The tracker's number: for a processor with a floating-point unit, single precision.
#[cfg(not(feature = "fixed"))]
pub type Number = f32;

/// Where the foot stood after a stride.
#[derive(Clone, Copy, Debug, PartialEq, defmt::Format)]
pub struct Footprint {
    /// m, from the start: x as the sensor's x axis pointed there, y to its left.
    pub place: [f32; 2],
    /// Standard deviations of that, m.
    pub sigma: [f32; 2],
    /// Whether the path can be relied upon, and why not.
    pub health: Health,
}

/// The foot: its sensor, and the path it walks.
pub struct Foot<B> {
    imu: Mpu6050<B>,
    tracker: EkfTracker<Number>,
    uncertainty: PathUncertainty<Number>,
}

impl<B: I2c> Foot<B> {
    /// Sets the sensor up: 16 g, 2000 °/s, so many samples a second (4 to 1000), an interrupt for each. A program that asks
    /// at times of its own lets it sample ten times as often, so that what it gets is new.
    ///
    /// # Errors
    /// The bus's, or [`Error::NotThere`].
    pub async fn new(bus: B, rate: u32) -> Result<Self, Error<B::Error>> {
        let (sensor, imu) = (SensorClass::Consumer, Mpu6050::new(bus, rate).await?);
        let tracker = EkfTracker::new(Config { sensor, ..Config::default() });
        Ok(Self { imu, tracker, uncertainty: PathUncertainty::new(sensor) })
    }

    /// Takes the sample that was ready at `time_us` (µs, any clock that does not go backwards); a footprint if it ended a
    /// stride.
    ///
    /// # Errors
    /// The bus's, or [`Error::Refused`]. The tracker is as it was, and the next sample may be taken.
    pub async fn step(&mut self, time_us: u64) -> Result<Option<Footprint>, Error<B::Error>> {
        let (specific_force, angular_rate) = self.imu.read().await?;
        let sample = ImuSample {
            time_us,
            specific_force: SVector::from(specific_force.map(Number::from_f32)),
            angular_rate: SVector::from(angular_rate.map(Number::from_f32)),
        };
        let estimate = self.tracker.update(&sample).map_err(Error::Refused)?;
        Ok(estimate.stride.map(|stride| {
            self.uncertainty.add(&stride);
            let [x, y, _] = stride.position.as_array().map(Scalar::to_f32);
            let sigma = self.uncertainty.standard_deviation();
            let [sx, sy, _] = sigma.as_array().map(Scalar::to_f32);
            let health = self.tracker.warnings().health();
            Footprint { place: [x, y], sigma: [sx, sy], health }
        }))
    }
}
