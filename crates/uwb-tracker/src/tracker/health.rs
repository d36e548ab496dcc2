//! Health of a tracker.

use super::Tracker;
use crate::{Health, health};
use kestirim_scalar::Scalar;

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// Health of the tracker at `time_us`.
    pub fn health(&self, time_us: u64) -> Health<T> {
        let position = self.estimate.as_ref().and_then(|estimate| {
            let variances = estimate.covariance.variances();
            let sum = variances.iter().take(D).fold(T::ZERO, |sum, &variance| sum + variance);
            Some((self.position()?, sum))
        });
        let still = self.is_still(time_us);
        let (of, heard) = ((&self.counters, &self.config), (&*self.links, &self.pace));
        health::health(of, heard, position, time_us, still)
    }
}
