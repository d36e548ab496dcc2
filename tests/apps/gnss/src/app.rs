//! Combines observations and orbits into solutions.

use embedded_io::{Read, ReadReady, Write};
use heapless::Vec;
use kestirim_gnss_ppp::GpsTime;
use kestirim_health::Reason;
use kestirim_ppp_filter::{
    Health as Doubts, Lean, PppFilter, SatelliteObservation, Solution, states,
};
use kestirim_telemetry::{EstimateHealth, GlobalPosition, Health, Transmitter};

use crate::observations::{Message, Observations, Observed, Receiver, SATELLITES};
use crate::source::{Source, Unusable, sighting};
use crate::{Error, site};

/// The number of satellites that are used at a time.
pub const VISIBLE: usize = 12;
/// The number of the filter's states.
pub const STATES: usize = states(VISIBLE);

/// A satellite that was observed but not used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Unused {
    /// The number of the satellite.
    pub satellite: u8,
    /// The reason.
    pub reason: Unusable,
}

/// The result of an epoch.
#[derive(Clone, Debug, PartialEq)]
pub struct Epoch {
    /// The position of the receiver, or the reason why there is none.
    pub solution: Result<Solution<STATES>, kestirim_ppp_filter::Error>,
    /// The satellites that were not used.
    pub unused: Vec<Unused, 32>,
}

/// A receiver that determines its position.
#[derive(Debug)]
pub struct App<R, S, W> {
    receiver: Receiver<R>,
    source: S,
    telemetry: Transmitter<W>,
    filter: PppFilter<STATES, Lean>,
    observed: Option<GpsTime>,
    /// When each satellite, by its number, was last part of a solution.
    solved: [Option<GpsTime>; SATELLITES + 1],
    accepted: u32,
    rejected: u32,
}

impl<R, S, W> App<R, S, W>
where
    R: Read + ReadReady,
    S: Source,
    W: Write,
{
    /// Creates the application from a u-blox receiver of two carriers that sends UBX-RXM-RAWX, and UBX-RXM-SFRBX if
    /// that is the source of orbits; and a serial port for telemetry.
    pub fn new(receiver: R, source: S, telemetry: W) -> Self {
        Self {
            receiver: Receiver::new(receiver),
            source,
            telemetry: Transmitter::new(telemetry),
            filter: PppFilter::new(S::config()),
            observed: None,
            solved: [None; SATELLITES + 1],
            accepted: 0,
            rejected: 0,
        }
    }

    /// Reads the data of both ports up to the next epoch, and updates the filter. `time_us` is the current time (µs
    /// since any moment).
    ///
    /// # Errors
    /// If a port fails.
    pub fn poll(&mut self, time_us: u64) -> Result<Option<Epoch>, Error> {
        self.source.poll()?;
        let observations = loop {
            match self.receiver.message().map_err(|_| Error::Receiver)? {
                Some(Message::Epoch(observations)) => break observations,
                Some(Message::Subframe { satellite, subframe }) => {
                    // Before the first epoch the week is unknown; each subframe is repeated within half a minute.
                    if let Some(time) = self.observed {
                        self.source.take(satellite, subframe, time);
                    }
                }
                None => return Ok(None),
            }
        };
        self.observed = Some(observations.time);
        let epoch = self.take_in(&observations);
        if let Ok(solution) = &epoch.solution {
            let position = GlobalPosition {
                time_us,
                position: solution.position.into(),
                // The deviation of a position that the observations contradict, or do not check, has no meaning.
                sigma: is_checked(solution.health)
                    .then(|| libm::sqrt(solution.covariance.trace() / 3.0) as f32),
            };
            self.telemetry.send(position).map_err(|_| Error::Telemetry)?;
        }
        let doubts = match &epoch.solution {
            Ok(solution) => solution.health.in_short(),
            // No position is sent for this epoch: the last one is out of date.
            Err(_) => Reason::Dropout.into(),
        };
        let health = EstimateHealth { time_us, reasons: doubts.bits() };
        self.telemetry.send(health).map_err(|_| Error::Telemetry)?;
        let Self { accepted, rejected, .. } = *self;
        let failed = self.receiver.damaged().saturating_add(self.source.damaged());
        let health = Health { time_us, accepted, rejected, failed };
        self.telemetry.send(health).map_err(|_| Error::Telemetry)?;
        Ok(Some(epoch))
    }

    fn take_in(&mut self, observations: &Observations) -> Epoch {
        let time = observations.time;
        let mut sightings: Vec<SatelliteObservation<'static>, VISIBLE> = Vec::new();
        let mut unused = Vec::new();
        for observed in &observations.satellites {
            let lost = self.lost(time, observed);
            let room = |sighting| sightings.push(sighting).map_err(|_| Unusable::NoRoom);
            if let Err(reason) = sighting(&self.source, time, observed, lost).and_then(room) {
                // There is room for as many satellites as can be observed.
                let _ = unused.push(Unused { satellite: observed.satellite, reason });
            }
        }
        let solution = self.filter.process(time, &site::receiver(), &sightings);
        match &solution {
            Ok(found) => {
                for used in &found.satellites {
                    if let Some(place) = self.solved.get_mut(usize::from(used.satellite)) {
                        *place = Some(time);
                    }
                }
                let is_wrong = matches!(found.health, Doubts::Contradicted(_));
                let count = if is_wrong { &mut self.rejected } else { &mut self.accepted };
                *count = count.saturating_add(1);
            }
            Err(_) => self.rejected = self.rejected.saturating_add(1),
        }
        Epoch { solution, unused }
    }

    /// Whether a phase has not been tracked since the satellite was last part of a solution.
    fn lost(&self, time: GpsTime, observed: &Observed) -> bool {
        let solved = self.solved.get(usize::from(observed.satellite)).copied().flatten();
        let Some(solved) = solved else { return false };
        let elapsed_ms = 1e3 * time.since(solved);
        // The receiver rounds down.
        observed
            .lock_ms
            .iter()
            .any(|&lock| lock < Observed::LONGEST_LOCK && f64::from(lock) + 1.0 < elapsed_ms)
    }
}

/// Whether the observations check a solution and agree with it.
const fn is_checked(health: Doubts) -> bool {
    matches!(health, Doubts::Converging | Doubts::Converged)
}
