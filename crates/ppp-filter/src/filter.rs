use crate::running::Running;
use crate::start::{agreement, code_position};
use crate::{Config, Error, SatelliteObservation, Solution};
use kestirim_gnss_ppp::{GpsTime, Receiver};

/// Where an epoch has no solution and its codes agree about a place farther away than this, the filter's is a wrong
/// one, m.
const ELSEWHERE: f64 = 1000.0;

/// A place at which the codes' residuals are three times smaller is the right one: their squares, nine times.
const MUCH_BETTER: f64 = 9.0;

/// A precise point positioning filter of N states: room for N − 5 satellites at a time (see
/// [`states`](crate::states)).
///
/// It starts by itself from the first epoch's codes.
#[derive(Clone, Copy, Debug)]
pub struct PppFilter<const N: usize> {
    config: Config,
    running: Option<Running<N>>,
}

impl<const N: usize> PppFilter<N> {
    /// A filter before its first epoch.
    pub const fn new(config: Config) -> Self {
        const { assert!(N >= crate::states(4), "no position from fewer than four satellites") };
        Self { config, running: None }
    }

    /// The settings.
    pub const fn config(&self) -> &Config {
        &self.config
    }

    /// Takes in an epoch, observed at `time` by the receiver's clock. Where the codes of five epochs were far from the
    /// place and agree about another, the default filter begins anew there; the published ones do not.
    ///
    /// # Errors
    /// [`Error`]: why the epoch has no solution. The filter is as it was.
    pub fn process(
        &mut self,
        time: GpsTime,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
    ) -> Result<Solution<N>, Error> {
        if !self.config.is_valid() {
            return Err(Error::InvalidConfiguration);
        }
        let Some(running) = self.running else {
            let start = code_position(observations)?;
            return self.take(Running::start(time, &start, &self.config), receiver, observations);
        };
        let mut next = running;
        next.advance(time, &self.config)?;
        // Codes that agree with each other, but have long not agreed with the place, know better.
        if let Some(square) = running.contradicted()
            && let Some((anew, agreement)) = self.anew(time, observations)
            && agreement * MUCH_BETTER < square
        {
            return self.take(anew, receiver, observations);
        }
        let solution = self.take(next, receiver, observations);
        if solution.is_err()
            && let Some((anew, _)) = self.anew(time, observations)
            && (anew.position() - running.position()).norm() > ELSEWHERE
        {
            return self.take(anew, receiver, observations);
        }
        solution
    }

    /// A beginning where the codes of an epoch agree about a place, and the mean square of their residuals there, m².
    #[cold]
    fn anew(
        &self,
        time: GpsTime,
        observations: &[SatelliteObservation<'_>],
    ) -> Option<(Running<N>, f64)> {
        // The published filters do not know better.
        self.config.estimator.patience?;
        let start = code_position(observations).ok()?;
        let agreement = agreement(observations, &start)?;
        let mut next = Running::start(time, &start, &self.config);
        // What contradicted goes on to: it may not be the place that was wrong.
        next.consistency = self.running.map_or(next.consistency, |running| running.consistency);
        Some((next, agreement))
    }

    /// Goes on with this state, if the epoch has a solution with it.
    #[inline(never)] // Large, and called from several places.
    fn take(
        &mut self,
        mut next: Running<N>,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
    ) -> Result<Solution<N>, Error> {
        let solution = next.observe(receiver, observations, &self.config);
        if solution.is_ok() {
            self.running = Some(next);
        }
        solution
    }
}
