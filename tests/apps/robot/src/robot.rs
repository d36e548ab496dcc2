//! The body of the loop, one anchor after the other.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::i2c::I2c;
use embedded_hal::spi::SpiBus;
use embedded_io::Write;
use kestirim_scalar::Scalar;
use kestirim_telemetry::{EstimateHealth, Health, Message, Position, Range, Transmitter};
use kestirim_uwb_tracker::{CalibratedPlaneTracker, Config, InertialSample, Outcome, RangeSample};

use crate::room::{HEIGHT, SITES, Site, metres};
use crate::{AccelerationError, Error, Imu, Number, Radio, RadioError, RangeError};

/// The result of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Step {
    /// The anchor that was polled.
    pub anchor: usize,
    /// The outcome of its range.
    pub range: Result<Outcome, RangeError>,
    /// The outcome of the acceleration, without which the robot can still be tracked.
    pub acceleration: Result<(), AccelerationError>,
}

/// A robot that determines its position and reports it.
pub struct Robot<B: SpiBus, CS: OutputPin, D, I, W> {
    radio: Radio<B, CS, D>,
    imu: Imu<I>,
    telemetry: Transmitter<W>,
    tracker: CalibratedPlaneTracker<Number, { SITES.len() }>,
    /// The anchor whose turn it is.
    anchor: usize,
    /// The number of exchanges and readings that failed.
    failed: u32,
}

impl<B, CS, D, I, W> Robot<B, CS, D, I, W>
where
    B: SpiBus,
    CS: OutputPin,
    D: DelayNs,
    I: I2c,
    W: Write,
{
    /// Creates a robot with these devices, somewhere in [the room](SITES).
    ///
    /// # Errors
    /// [`Error::Room`].
    pub fn new(radio: Radio<B, CS, D>, imu: Imu<I>, telemetry: W) -> Result<Self, Error> {
        let config = Config::calibrated(metres(HEIGHT));
        let tracker = CalibratedPlaneTracker::new(config, &SITES.each_ref().map(Site::anchor))
            .map_err(Error::Room)?;
        let telemetry = Transmitter::new(telemetry);
        Ok(Self { radio, imu, telemetry, tracker, anchor: 0, failed: 0 })
    }

    /// Takes the acceleration and the range to the next anchor, and returns their outcomes. `time_us` must not go back
    /// (µs since any moment).
    ///
    /// # Errors
    /// [`Error::Radio`] or [`Error::Telemetry`]. Silent anchors and refused samples are reported and counted, and the
    /// next step goes on.
    pub fn step(&mut self, time_us: u64) -> Result<Step, Error> {
        let acceleration = self.feel(time_us);
        let anchor = self.anchor;
        let range = match SITES.get(anchor) {
            Some(site) => self.range(time_us, anchor, site)?,
            None => Err(RangeError::Refused(kestirim_uwb_tracker::Error::NoSuchAnchor)),
        };
        let failed = [
            matches!(acceleration, Err(AccelerationError::Imu(_))),
            matches!(range, Err(RangeError::Radio(_) | RangeError::Exchange(_))),
        ];
        self.failed = self.failed.saturating_add(failed.map(u32::from).iter().sum());
        if range.is_ok() {
            self.tell_position(time_us)?;
        }
        self.anchor += 1;
        if self.anchor >= SITES.len() {
            self.anchor = 0;
            self.tell_health(time_us)?;
        }
        Ok(Step { anchor, range, acceleration })
    }

    /// Passes the acceleration to the tracker, which detects from it whether the robot stands.
    fn feel(&mut self, time_us: u64) -> Result<(), AccelerationError> {
        let acceleration = self.imu.acceleration().map_err(AccelerationError::Imu)?;
        let sample = InertialSample { time_us, acceleration, push: None };
        self.tracker.inertial(&sample).map_err(AccelerationError::Refused)
    }

    fn range(
        &mut self,
        time_us: u64,
        anchor: usize,
        site: &Site,
    ) -> Result<Result<Outcome, RangeError>, Error> {
        let exchange = match self.radio.exchange(site.address) {
            Ok(exchange) => exchange,
            Err(RadioError::Lost) => return Err(Error::Radio),
            Err(error) => return Ok(Err(RangeError::Radio(error))),
        };
        let range = match exchange.asymmetric::<Number>() {
            Ok(distance) => distance - site.excess(),
            Err(error) => return Ok(Err(RangeError::Exchange(error))),
        };
        self.send(Range { time_us, anchor: anchor as u16, range: range.to_f32() })?;
        let report = self.tracker.range(&RangeSample { time_us, anchor, range });
        Ok(report.map(|report| report.outcome).map_err(RangeError::Refused))
    }

    fn tell_position(&mut self, time_us: u64) -> Result<(), Error> {
        let Some(position) = self.tracker.position() else { return Ok(()) };
        let position = [position.x, position.y, metres(HEIGHT)].map(Scalar::to_f32);
        // The tracker gives the standard deviation of both components together.
        let sigma = self.tracker.health(time_us).position_sigma;
        let sigma = sigma.map(|sigma| sigma.to_f32() * core::f32::consts::FRAC_1_SQRT_2);
        self.send(Position { time_us, position, sigma })
    }

    /// Sends the health after every round.
    fn tell_health(&mut self, time_us: u64) -> Result<(), Error> {
        let health = self.tracker.health(time_us);
        let (accepted, rejected, failed) = (health.taken, health.rejected, self.failed);
        self.send(Health { time_us, accepted, rejected, failed })?;
        self.send(EstimateHealth { time_us, reasons: health.in_short().bits() })
    }

    fn send(&mut self, message: impl Into<Message>) -> Result<(), Error> {
        self.telemetry.send(message).map_err(|_| Error::Telemetry)
    }
}
