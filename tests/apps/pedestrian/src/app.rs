use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use embedded_io::Write;
use kestirim_pedestrian::{
    Config, EkfTracker, Error as Refusal, Estimate, Health as Doubts, ImuSample, PathUncertainty,
    Stride,
};
use kestirim_scalar::{Components, Scalar};
use kestirim_telemetry::{EstimateHealth, Footprint, Health, Position, Transmitter};
use nalgebra::SVector;

use crate::log::Log;
use crate::{Counts, Error, Imu, SensorError};

/// The number of samples per transmitted position, which makes ten positions a second.
const SAMPLES_A_POSITION: u32 = 10;

/// The [`Error`] of an application with these peripherals.
type Failure<I2C, F, P> = Error<
    SensorError<<I2C as embedded_hal::i2c::ErrorType>::Error>,
    <F as embedded_io::ErrorType>::Error,
    <P as embedded_io::ErrorType>::Error,
>;

/// A noteworthy event with a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Event {
    /// The foot has come to a stand at this position (m, earth frame: z up, from the start).
    Stance([f32; 3]),
    /// The foot has left a stance that ended a stride: the stride's horizontal length (m).
    Stride(f32),
    /// The tracker refused the sample.
    Refused(Refusal),
}

/// The summary of a finished walk.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Summary {
    /// The number of accepted samples.
    pub accepted: u32,
    /// The number of samples that the tracker refused.
    pub rejected: u32,
    /// The number of readings that the sensor's driver did not deliver.
    pub failed: u32,
    /// The length of the horizontal path from stance to stance (m).
    pub path: f32,
    /// Whether the path can be relied upon.
    pub health: Doubts,
}

/// The application: `T` is the tracker's scalar, `F` the file of the log, `P` the port for telemetry.
pub struct App<T: Scalar, I2C, F, P> {
    imu: Imu<I2C>,
    tracker: EkfTracker<T>,
    uncertainty: PathUncertainty<T>,
    /// The health that was last sent.
    told: Option<Doubts>,
    log: Log<F>,
    line: Transmitter<P>,
    standing: bool,
    position: [f32; 3],
    time_us: u64,
    accepted: u32,
    rejected: u32,
    failed: u32,
}

impl<T: Scalar, I2C: I2c, F: Write, P: Write> App<T, I2C, F, P> {
    /// Sets the sensor up.
    ///
    /// # Errors
    /// [`Error::Sensor`].
    pub fn new(
        i2c: I2C,
        delay: &mut impl DelayNs,
        file: F,
        port: P,
    ) -> Result<Self, Failure<I2C, F, P>> {
        let config = Config::default();
        Ok(Self {
            imu: Imu::new(i2c, delay).map_err(Error::Sensor)?,
            tracker: EkfTracker::new(config),
            uncertainty: PathUncertainty::new(config.sensor),
            told: None,
            log: Log::new(file),
            line: Transmitter::new(port),
            standing: false,
            position: [0.0; 3],
            time_us: 0,
            accepted: 0,
            rejected: 0,
            failed: 0,
        })
    }

    /// Processes the sensor's pending sample, if any. It was taken at `time_us` (µs, any clock that does not go
    /// backwards).
    ///
    /// # Errors
    /// [`Error`]: a part of the hardware failed. The others have done their work, and the next call goes on.
    pub fn poll(&mut self, time_us: u64) -> Result<Option<Event>, Failure<I2C, F, P>> {
        let counts = match self.imu.read() {
            Ok(Some(counts)) => counts,
            Ok(None) => return Ok(None),
            Err(error) => {
                self.failed = self.failed.saturating_add(1);
                return Err(Error::Sensor(error));
            }
        };
        self.time_us = time_us;
        let logged = self.log.add(time_us, &counts).map_err(Error::Log);
        let (event, sent) = match self.track(time_us, &counts) {
            Ok(estimate) => (self.event(&estimate), self.tell(&counts, estimate.stride)),
            Err(refusal) => {
                self.rejected = self.rejected.saturating_add(1);
                (Some(Event::Refused(refusal)), Ok(()))
            }
        };
        logged.and(sent.map_err(Error::Port)).map(|()| event)
    }

    /// Ends the walk: completes the log, and sends the last position and the numbers of samples.
    ///
    /// # Errors
    /// [`Error`]; the other part has done its work.
    pub fn finish(&mut self) -> Result<Summary, Failure<I2C, F, P>> {
        let closed = self.log.close().map_err(Error::Log);
        let stride = self.tracker.finish();
        let Self { time_us, accepted, rejected, failed, .. } = *self;
        let counts = Health { time_us, accepted, rejected, failed };
        let sent = self
            .tell_stride(stride)
            .and_then(|()| self.tell_position())
            .and_then(|()| self.tell_health())
            .and_then(|()| self.line.send(counts));
        closed.and(sent.map_err(Error::Port))?;
        let (path, health) =
            (self.tracker.path_length().to_f32(), self.tracker.warnings().health());
        Ok(Summary { accepted, rejected, failed, path, health })
    }

    fn track(&mut self, time_us: u64, counts: &Counts) -> Result<Estimate<T>, Refusal> {
        let estimate = self.tracker.update(&ImuSample {
            time_us,
            specific_force: SVector::from(counts.specific_force().map(T::from_f32)),
            angular_rate: SVector::from(counts.angular_rate().map(T::from_f32)),
        })?;
        self.accepted = self.accepted.saturating_add(1);
        self.position = metres(&estimate.position);
        Ok(estimate)
    }

    fn event(&mut self, estimate: &Estimate<T>) -> Option<Event> {
        let stood = core::mem::replace(&mut self.standing, estimate.stance);
        match &estimate.stride {
            Some(stride) => Some(Event::Stride(stride.length.to_f32())),
            None => (estimate.stance && !stood).then_some(Event::Stance(self.position)),
        }
    }

    fn tell(&mut self, counts: &Counts, stride: Option<Stride<T>>) -> Result<(), P::Error> {
        let time_us = self.time_us;
        self.line.send(kestirim_telemetry::Imu {
            time_us,
            specific_force: counts.specific_force(),
            angular_rate: counts.angular_rate(),
        })?;
        if self.accepted.is_multiple_of(SAMPLES_A_POSITION) {
            self.tell_position()?;
        }
        self.tell_stride(stride)?;
        self.tell_health()
    }

    fn tell_position(&mut self) -> Result<(), P::Error> {
        let Self { time_us, position, .. } = *self;
        let [x, y, _] = *self.uncertainty.standard_deviation().as_array();
        self.line.send(Position { time_us, position, sigma: Some(x.max(y).to_f32()) })
    }

    /// Sends whether the path can be relied upon, if that has changed.
    fn tell_health(&mut self) -> Result<(), P::Error> {
        let health = self.tracker.warnings().health();
        if self.told.replace(health) == Some(health) {
            return Ok(());
        }
        self.line.send(EstimateHealth { time_us: self.time_us, reasons: health.bits() })
    }

    fn tell_stride(&mut self, stride: Option<Stride<T>>) -> Result<(), P::Error> {
        let Some(stride) = stride else { return Ok(()) };
        self.uncertainty.add(&stride);
        let Stride { time_us, position, length, .. } = stride;
        let (position, length) = (metres(&position), length.to_f32());
        self.line.send(Footprint { time_us, position, length })
    }
}

fn metres<T: Scalar>(position: &SVector<T, 3>) -> [f32; 3] {
    position.as_array().map(T::to_f32)
}
