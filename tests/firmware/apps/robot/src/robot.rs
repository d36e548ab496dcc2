//! The loop's body: one anchor after the other.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::i2c::I2c;
use embedded_hal::spi::SpiBus;
use embedded_io::Write;
use kestirim_scalar::Scalar;
use kestirim_telemetry as telemetry;
use kestirim_uwb_ranging::DoubleSided;
use kestirim_uwb_tracker::{
    CalibratedPlaneTracker, Config, InertialSample, Outcome, RangeSample, State,
};

use crate::line::{Line, LineError};
use crate::room::{HEIGHT, SITES, Site, metres};
use crate::{Imu, Number, Radio, RadioError};

/// Why the robot cannot go on: what helps is a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
#[non_exhaustive]
pub enum Error {
    /// The bus of the radio failed.
    Radio,
    /// The serial line takes nothing.
    Line,
    /// The room's anchors are not what the tracker can work with.
    Room(kestirim_uwb_tracker::Error),
}

impl From<LineError> for Error {
    fn from(_: LineError) -> Self {
        Self::Line
    }
}

/// A robot that knows where it is, and tells.
pub struct Robot<B: SpiBus, CS: OutputPin, D, I, W> {
    radio: Radio<B, CS, D>,
    imu: Imu<I>,
    line: Line<W>,
    tracker: CalibratedPlaneTracker<Number, { SITES.len() }>,
    /// Whose turn it is.
    anchor: usize,
    /// Exchanges and readings that failed.
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
    /// A robot with these devices, somewhere in [the room](SITES).
    ///
    /// # Errors
    /// [`Error::Room`].
    pub fn new(radio: Radio<B, CS, D>, imu: Imu<I>, line: W) -> Result<Self, Error> {
        let config = Config::calibrated(metres(HEIGHT));
        let tracker = CalibratedPlaneTracker::new(config, &SITES.each_ref().map(Site::anchor))
            .map_err(Error::Room)?;
        Ok(Self { radio, imu, line: Line::new(line), tracker, anchor: 0, failed: 0 })
    }

    /// Takes in the acceleration and the range to the next anchor, and tells what became of them.
    /// `time_us` never goes back (µs since any moment).
    ///
    /// # Errors
    /// [`Error::Radio`] or [`Error::Line`]. Silent anchors and samples that do not fit are no errors:
    /// they are counted, and the next step goes on.
    pub fn step(&mut self, time_us: u64) -> Result<(), Error> {
        self.feel(time_us);
        if let Some(site) = SITES.get(self.anchor) {
            self.ask(time_us, self.anchor, site)?;
        }
        self.anchor += 1;
        if self.anchor >= SITES.len() {
            self.anchor = 0;
            self.tell_health(time_us)?;
        }
        Ok(())
    }

    fn ask(&mut self, time_us: u64, anchor: usize, site: &Site) -> Result<(), Error> {
        match self.radio.exchange(site.address) {
            Ok(exchange) => self.take_in(time_us, anchor, site, &exchange),
            Err(RadioError::Lost) => Err(Error::Radio),
            Err(error) => {
                self.failed = self.failed.saturating_add(1);
                defmt::debug!("anchor {}: {}", anchor, error);
                Ok(())
            }
        }
    }

    /// Lets the tracker feel whether the robot stands.
    fn feel(&mut self, time_us: u64) {
        match self.imu.acceleration() {
            Ok(acceleration) => {
                let sample = InertialSample { time_us, acceleration, push: None };
                if let Err(error) = self.tracker.inertial(&sample) {
                    defmt::warn!("acceleration refused: {}", error);
                }
            }
            // Without an IMU the robot still finds its way.
            Err(error) => {
                self.failed = self.failed.saturating_add(1);
                defmt::warn!("no acceleration: {}", error);
            }
        }
    }

    fn take_in(
        &mut self,
        time_us: u64,
        anchor: usize,
        site: &Site,
        exchange: &DoubleSided,
    ) -> Result<(), Error> {
        let distance: Number = match exchange.asymmetric() {
            Ok(distance) => distance,
            Err(error) => {
                self.failed = self.failed.saturating_add(1);
                defmt::warn!("anchor {}: {}", anchor, error);
                return Ok(());
            }
        };
        let range = distance - site.excess();
        self.line.send(telemetry::Range {
            time_us,
            anchor: anchor as u16,
            range: range.to_f32(),
        })?;
        match self.tracker.range(&RangeSample { time_us, anchor, range }) {
            Ok(report) if report.outcome == Outcome::Started => {
                defmt::info!("the tracker has started");
            }
            Ok(report) => defmt::trace!("anchor {}: {}", anchor, report.outcome),
            Err(error) => defmt::warn!("range refused: {}", error),
        }
        self.tell_position(time_us)
    }

    fn tell_position(&mut self, time_us: u64) -> Result<(), Error> {
        let Some(position) = self.tracker.position() else { return Ok(()) };
        let sigma = self.tracker.health(time_us).position_sigma;
        self.line.send(telemetry::Position {
            time_us,
            position: [position.x, position.y, metres(HEIGHT)].map(Scalar::to_f32),
            // Of one component, if both are alike.
            sigma: sigma.map(|sigma| sigma.to_f32() * core::f32::consts::FRAC_1_SQRT_2),
        })?;
        Ok(())
    }

    /// After every round: how the tracker feels.
    fn tell_health(&mut self, time_us: u64) -> Result<(), Error> {
        let health = self.tracker.health(time_us);
        if matches!(health.state, State::Lost | State::Coasting) {
            defmt::warn!("{}: {} anchors heard", health.state, health.heard);
        }
        self.line.send(telemetry::Health {
            time_us,
            accepted: health.taken,
            rejected: health.rejected,
            failed: self.failed,
        })?;
        Ok(())
    }
}
