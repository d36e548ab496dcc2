//! Combines positions and levels into estimates of the user's position.

use embedded_io::{Read, ReadReady, Write};
use kestirim_air_to_ground::Measurement;
use kestirim_particle_filter::Xoshiro128PlusPlus;
use kestirim_telemetry::{EstimateHealth, Health, PathLoss, Position, Transmitter};
use kestirim_user_locator::{Health as Doubts, Reason, TrackEstimate, Tracker};
use rand_core::{SeedableRng, TryRng};

use crate::beacon::Beacon;
use crate::gps::Degree;
use crate::lines::Lines;
use crate::site::{self, FRESH_US, LEVEL, USER};
use crate::{Error, PARTICLES};

/// The result of a poll.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Event {
    /// A new estimate of the user's current position.
    Located(TrackEstimate<f32>),
    /// The user was received, but the position of the drone was unknown.
    NoFix,
    /// The filter refused a measurement; it has only advanced in time.
    Refused(kestirim_user_locator::Error),
}

impl Event {
    /// Whether the estimate of the user's position can be relied upon after this event.
    fn doubts(&self) -> Doubts {
        Doubts::GOOD
            .with(Reason::Dropout, *self == Self::NoFix)
            .with(Reason::Rejected, matches!(self, Self::Refused(_)))
    }
}

/// A drone that locates a user.
#[derive(Debug)]
pub struct App<G, B, W> {
    gps: Lines<G>,
    radio: Lines<B>,
    telemetry: Transmitter<W>,
    degree: Degree,
    tracker: Tracker<f32, PARTICLES>,
    rng: Xoshiro128PlusPlus,
    /// East, north and up, m, and the time of the position (µs).
    place: Option<([f32; 3], u64)>,
    measured_us: Option<u64>,
    accepted: u32,
    rejected: u32,
    failed: u32,
}

impl<G, B, W> App<G, B, W>
where
    G: Read + ReadReady,
    B: Read + ReadReady,
    W: Write,
{
    /// Creates the application from a satellite receiver, a radio module, a serial port for telemetry, and a source of
    /// randomness that seeds the particles.
    ///
    /// # Errors
    /// [`Error::Entropy`] or [`Error::Site`].
    pub fn new(gps: G, radio: B, telemetry: W, entropy: &mut impl TryRng) -> Result<Self, Error> {
        let mut rng = Xoshiro128PlusPlus::try_from_rng(entropy).map_err(|_| Error::Entropy)?;
        let tracker = Tracker::new(site::channel()?, site::motion(), &site::region()?, &mut rng);
        Ok(Self {
            gps: Lines::new(gps),
            radio: Lines::new(radio),
            telemetry: Transmitter::new(telemetry),
            degree: Degree::at_origin(),
            tracker,
            rng,
            place: None,
            measured_us: None,
            accepted: 0,
            rejected: 0,
            failed: 0,
        })
    }

    /// Reads the data of both modules up to the next beacon of the user, and updates the filter. `time_us` is the
    /// current time (µs since any moment), and must not go back.
    ///
    /// # Errors
    /// If a port fails.
    pub fn poll(&mut self, time_us: u64) -> Result<Option<Event>, Error> {
        let degree = self.degree;
        let place = |line: &str| degree.place(line);
        while let Some(place) = self.gps.find(place).map_err(|_| Error::Gps)? {
            self.place = Some((place, time_us));
        }
        let users = |line: &str| Beacon::read(line).filter(|beacon| beacon.address == USER);
        let Some(beacon) = self.radio.find(users).map_err(|_| Error::Radio)? else {
            return Ok(None);
        };
        let event = match self.place {
            Some((place, at_us)) if time_us.saturating_sub(at_us) <= FRESH_US => {
                self.measure(time_us, place, LEVEL - f32::from(beacon.level))?
            }
            _ => {
                self.failed = self.failed.saturating_add(1);
                Event::NoFix
            }
        };
        let Self { accepted, rejected, failed, .. } = *self;
        let health = Health { time_us, accepted, rejected, failed };
        self.telemetry.send(health).map_err(|_| Error::Telemetry)?;
        let reasons = event.doubts().bits();
        let health = EstimateHealth { time_us, reasons };
        self.telemetry.send(health).map_err(|_| Error::Telemetry)?;
        Ok(Some(event))
    }

    fn measure(&mut self, time_us: u64, place: [f32; 3], loss: f32) -> Result<Event, Error> {
        self.telemetry.send(PathLoss { time_us, place, loss }).map_err(|_| Error::Telemetry)?;
        if let Err(error) = self.take_in(time_us, place, loss) {
            self.rejected = self.rejected.saturating_add(1);
            return Ok(Event::Refused(error));
        }
        self.accepted = self.accepted.saturating_add(1);
        let estimate = self.tracker.estimate();
        let [x, y] = estimate.place;
        // The spread is that of both components together.
        let sigma = Some(estimate.spread * core::f32::consts::FRAC_1_SQRT_2);
        let position = Position { time_us, position: [x, y, 0.0], sigma };
        self.telemetry.send(position).map_err(|_| Error::Telemetry)?;
        Ok(Event::Located(estimate))
    }

    fn take_in(
        &mut self,
        time_us: u64,
        [x, y, height]: [f32; 3],
        loss: f32,
    ) -> Result<(), kestirim_user_locator::Error> {
        let measurement = Measurement::new([x, y], height, loss)?;
        if let Some(before_us) = self.measured_us {
            let interval = time_us.saturating_sub(before_us) as f32 * 1e-6;
            self.tracker.predict(interval, &mut self.rng)?;
        }
        self.measured_us = Some(time_us);
        self.tracker.measure(&measurement, &mut self.rng)?;
        Ok(())
    }
}
