//! Health of a tracker.

use super::Tracker;
use crate::{Health, State};
use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::{dilution_of_precision, expected_range};

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// Health of the tracker at `time_us`.
    pub fn health(&self, time_us: u64) -> Health<T> {
        let counters = &self.counters;
        let heard = self.count_heard(time_us);
        let dilution = self.dilution(time_us);
        let bias_sigma = dilution.map_or(T::ZERO, |dilution| dilution * self.config.bias_sigma);
        let position_sigma = self.estimate.as_ref().map(|estimate| {
            let variances = estimate.covariance.variances();
            let sum = variances.iter().take(D).fold(T::ZERO, |sum, &variance| sum + variance);
            sum.sqrt().hypot(bias_sigma)
        });
        Health {
            state: match (&self.estimate, counters.starts) {
                (None, 0) => State::Initialising,
                (None, _) => State::Lost,
                (Some(_), _) if heard == 0 => State::Coasting,
                (Some(_), _) => State::Tracking,
            },
            nis: counters.nis,
            taken: counters.taken,
            rejected: counters.rejected,
            restarts: counters.starts.saturating_sub(1),
            heard,
            dilution,
            position_sigma,
            bias_sigma,
            still: self.is_still(time_us),
        }
    }

    fn dilution(&self, time_us: u64) -> Option<T> {
        let position = self.position()?;
        let heard = self.links.iter().filter(|link| link.fresh(time_us).is_some());
        let directions = heard.map(|link| {
            expected_range(&position, self.config.height, &link.anchor.position).direction
        });
        dilution_of_precision(directions).ok()
    }
}
