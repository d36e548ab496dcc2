use crate::running::Running;
use crate::{Config, Error, SatelliteObservation, Solution, Weighting};
use kestirim_gnss_ppp::{GpsTime, Receiver};
use kestirim_robust_kalman::Robust;

/// A precise point positioning filter of N states: room for N − 5 satellites at a time, N − 7 with gradients (see
/// [`states`](crate::states)).
///
/// It starts by itself from the first epoch's codes. How it weighs observations is chosen at run time by its settings, unless
/// R is a type that has the choice made ([`Lean`](crate::Lean)) and so takes less flash.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PppFilter<const N: usize, R = Robust<f64>> {
    config: Config<R>,
    pub(crate) running: Option<Running<N>>,
}

impl<const N: usize, R> PppFilter<N, R> {
    /// A filter before its first epoch.
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
    /// Takes in an epoch, observed at `time` by the receiver's clock.
    ///
    /// # Errors
    /// [`Error`]: why the epoch has no solution. The filter is as it was.
    pub fn process(
        &mut self,
        time: GpsTime,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
    ) -> Result<Solution<N>, Error> {
        self.step(time, 1.0, receiver, observations)
    }

    /// Takes in an epoch that was observed before the one that was taken in last: for a recording that is gone through from
    /// its end. A satellite's `lock_lost` says then that its lock was lost on the way to the epoch that came after.
    ///
    /// # Errors
    /// [`Error`]: why the epoch has no solution. The filter is as it was.
    pub fn process_backwards(
        &mut self,
        time: GpsTime,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
    ) -> Result<Solution<N>, Error> {
        self.step(time, -1.0, receiver, observations)
    }

    /// `direction` is 1 or −1.
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
