//! A foot-mounted MPU-6050 and its tracker, for any board with async I²C: the board's program calls [`Foot::step`] for
//! each sample, for example at the sensor's interrupt.
#![no_std]

mod mpu6050;

use embedded_hal_async::i2c::I2c;
use kestirim_health::Health;
use kestirim_pedestrian::{Config, EkfTracker, ImuSample, PathUncertainty, SensorClass};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

use mpu6050::Mpu6050;

pub use mpu6050::Error;

/// The number type of the tracker: fixed point, for a processor without a floating-point unit.
#[cfg(feature = "fixed")]
pub type Number = kestirim_scalar::Q12_20;
/// The number type of the tracker: single precision, for a processor with a floating-point unit.
#[cfg(not(feature = "fixed"))]
pub type Number = f32;

/// The place where the foot stood at the end of a stride.
#[derive(Clone, Copy, Debug, PartialEq, defmt::Format)]
pub struct Footprint {
    /// The place relative to the start, m: x in the direction of the sensor's x axis at the start, y to the left of it.
    pub place: [f32; 2],
    /// Standard deviations of the place, m.
    pub sigma: [f32; 2],
    /// Whether the path can be relied upon, and why not.
    pub health: Health,
}

/// A foot with its sensor, and the tracker of its path.
pub struct Foot<B> {
    imu: Mpu6050<B>,
    tracker: EkfTracker<Number>,
    uncertainty: PathUncertainty<Number>,
}

impl<B: I2c> Foot<B> {
    /// Sets the sensor up for ±16 g and ±2000 °/s, with `rate` samples per second (4 to 1000) and an interrupt for
    /// each. A program that reads without the interrupt chooses a rate ten times its own, so that every reading is
    /// fresh.
    ///
    /// # Errors
    /// [`Error::Bus`] or [`Error::NotThere`].
    pub async fn new(bus: B, rate: u32) -> Result<Self, Error<B::Error>> {
        let (sensor, imu) = (SensorClass::Consumer, Mpu6050::new(bus, rate).await?);
        let tracker = EkfTracker::new(Config { sensor, ..Config::default() });
        Ok(Self { imu, tracker, uncertainty: PathUncertainty::new(sensor) })
    }

    /// Reads and processes the sample that was ready at `time_us` (µs on any clock that does not go backwards). Returns
    /// a footprint if the sample completed a stride.
    ///
    /// # Errors
    /// [`Error::Bus`], [`Error::NotThere`] or [`Error::Refused`]. The tracker is unchanged, and the next sample may be
    /// processed.
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
