use crate::running::Running;
use crate::{Config, Error, SatelliteObservation, Solution, Weighting};
use kestirim_gnss_ppp::{GpsTime, Receiver};
use kestirim_robust_kalman::Robust;

/// A precise point positioning filter of N states, with room for N − 5 satellites at a time, N − 7 with gradients (see
/// [`states`](crate::states)).
///
/// It initialises itself from the first epoch's codes. The weighting of observations is chosen at run time by its
/// settings, unless R is a type that fixes the choice ([`Lean`](crate::Lean)) and so takes less flash.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PppFilter<const N: usize, R = Robust<f64>> {
    config: Config<R>,
    pub(crate) running: Option<Running<N>>,
}

impl<const N: usize, R> PppFilter<N, R> {
    /// Creates a filter that awaits its first epoch.
    pub const fn new(config: Config<R>) -> Self {
        const { assert!(N >= crate::states(4), "no position from fewer than four satellites") };
        Self { config, running: None }
    }

    /// The settings.
    pub const fn config(&self) -> &Config<R> {
        &self.config
    }
}

impl<const N: usize, R: Weighting> PppFilter<N, R> {
    /// Processes an epoch, observed at `time` by the receiver's clock.
    ///
    /// # Errors
    /// [`Error`]: why the epoch has no solution. The filter is unchanged.
    pub fn process(
        &mut self,
        time: GpsTime,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
    ) -> Result<Solution<N>, Error> {
        self.step(time, 1.0, receiver, observations)
    }

    /// Processes an epoch that precedes the one processed last, to go through a recording from its end.
    ///
    /// A satellite's `lock_lost` then means that lock was lost between this epoch and the one that follows it in time.
    ///
    /// # Errors
    /// [`Error`]: why the epoch has no solution. The filter is unchanged.
    pub fn process_backwards(
        &mut self,
        time: GpsTime,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
    ) -> Result<Solution<N>, Error> {
        self.step(time, -1.0, receiver, observations)
    }

    /// Processes an epoch in a `direction` of time, 1 or −1.
    fn step(
        &mut self,
        time: GpsTime,
        direction: f64,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
    ) -> Result<Solution<N>, Error> {
        if !self.config.is_valid() {
            return Err(Error::InvalidConfiguration);
        }
        let mut next = match self.running {
            Some(mut running) => {
                running.advance(time, direction, &self.config)?;
                running
            }
            None => Running::start(time, observations, &self.config)?,
        };
        let solution = next.observe(receiver, observations, &self.config);
        if solution.is_ok() {
            self.running = Some(next);
        }
        solution
    }
}
