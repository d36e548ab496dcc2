//! What is done with observations and products.

use embedded_io::{Read, ReadReady, Write};
use heapless::Vec;
use kestirim_gnss_ppp::GpsTime;
use kestirim_ppp_filter::{Lean, PppFilter, SatelliteObservation, Solution, states};
use kestirim_telemetry::{GlobalPosition, Health, Transmitter};

use crate::lines::Lines;
use crate::observations::{Observations, Observed, Receiver};
use crate::products::{Products, Unusable};
use crate::{Error, site};

/// Satellites that are used at a time.
pub const VISIBLE: usize = 12;
/// The filter's states.
pub const STATES: usize = states(VISIBLE);

/// A satellite that was observed and does not serve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Unused {
    /// Its number.
    pub satellite: u8,
    /// Why.
    pub reason: Unusable,
}

/// What became of an epoch.
#[derive(Clone, Debug, PartialEq)]
pub struct Epoch {
    /// Where the receiver is, or why nobody knows.
    pub solution: Result<Solution<STATES>, kestirim_ppp_filter::Error>,
    /// What did not serve.
    pub unused: Vec<Unused, 32>,
}

/// A receiver that finds its place.
#[derive(Debug)]
pub struct App<R, M, W> {
    receiver: Receiver<R>,
    modem: Lines<M>,
    telemetry: Transmitter<W>,
    products: Products,
    filter: PppFilter<STATES, Lean>,
    solved: Option<GpsTime>,
    accepted: u32,
    rejected: u32,
    malformed: u32,
}

impl<R, M, W> App<R, M, W>
where
    R: Read + ReadReady,
    M: Read + ReadReady,
    W: Write,
{
    /// With a u-blox receiver of two carriers that sends UBX-RXM-RAWX, a modem that hands on products before they
    /// are needed, and a serial port for telemetry.
    pub fn new(receiver: R, modem: M, telemetry: W) -> Self {
        Self {
            receiver: Receiver::new(receiver),
            modem: Lines::new(modem),
            telemetry: Transmitter::new(telemetry),
            products: Products::new(),
            filter: PppFilter::new(site::config()),
            solved: None,
            accepted: 0,
            rejected: 0,
            malformed: 0,
        }
    }

    /// Reads what both have sent up to the next epoch, and takes that in. `time_us` is now (µs since any moment).
    ///
    /// # Errors
    /// A port's.
    pub fn poll(&mut self, time_us: u64) -> Result<Option<Epoch>, Error> {
        let (products, malformed) = (&mut self.products, &mut self.malformed);
        let read = |line: &str| {
            let refused = products.read(line).is_err();
            *malformed = malformed.saturating_add(refused.into());
        };
        self.modem.each(read).map_err(|_| Error::Modem)?;
        let Some(observations) = self.receiver.epoch().map_err(|_| Error::Receiver)? else {
            return Ok(None);
        };
        let epoch = self.take_in(&observations);
        if let Ok(solution) = &epoch.solution {
            let position = GlobalPosition {
                time_us,
                position: solution.position.into(),
                sigma: Some(libm::sqrt(solution.covariance.trace() / 3.0) as f32),
            };
            self.telemetry.send(position).map_err(|_| Error::Telemetry)?;
        }
        let Self { accepted, rejected, .. } = *self;
        let failed = self.receiver.damaged().saturating_add(self.malformed);
        let health = Health { time_us, accepted, rejected, failed };
        self.telemetry.send(health).map_err(|_| Error::Telemetry)?;
        Ok(Some(epoch))
    }

    fn take_in(&mut self, observations: &Observations) -> Epoch {
        let time = observations.time;
        let mut sightings: Vec<SatelliteObservation<'static>, VISIBLE> = Vec::new();
        let mut unused = Vec::new();
        for observed in &observations.satellites {
            let sighting = self.products.sighting(time, observed, self.lost(time, observed));
            let room = |sighting| sightings.push(sighting).map_err(|_| Unusable::NoRoom);
            if let Err(reason) = sighting.and_then(room) {
                // As many as there are observed at most.
                let _ = unused.push(Unused { satellite: observed.satellite, reason });
            }
        }
        let solution = self.filter.process(time, &site::receiver(), &sightings);
        match solution {
            Ok(_) => {
                self.solved = Some(time);
                self.accepted = self.accepted.saturating_add(1);
            }
            Err(_) => self.rejected = self.rejected.saturating_add(1),
        }
        Epoch { solution, unused }
    }

    /// Whether a phase has not been tracked since the last epoch with a solution.
    fn lost(&self, time: GpsTime, observed: &Observed) -> bool {
        let Some(solved) = self.solved else { return false };
        let elapsed_ms = 1e3 * time.since(solved);
        // The receiver rounds down.
        observed
            .lock_ms
            .iter()
            .any(|&lock| lock < Observed::LONGEST_LOCK && f64::from(lock) + 1.0 < elapsed_ms)
    }
}
