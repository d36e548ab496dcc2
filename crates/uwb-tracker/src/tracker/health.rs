//! Health of a tracker.

use super::Tracker;
use crate::health::{self, Common, Place};
use crate::{Config, Health};
use kestirim_scalar::{Components, Scalar};

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// Health of the tracker at `time_us`.
    pub fn health(&self, time_us: u64) -> Health<T> {
        let sigma = self.considered_bias().unwrap_or(T::ZERO);
        self.health_beside(Common { sigma, shape: self.bias_shape }, time_us)
    }

    /// Standard deviation of the common bias where it is a state, but not updated, as too few anchors are heard, m.
    ///
    /// A value learnt from four anchors or more includes the mean of their own constant errors: half of one's or less.
    /// It is no less certain than the prior, even if the whole estimate was widened since.
    fn considered_bias(&self) -> Option<T> {
        let estimate = self.estimate().filter(|_| N > 2 * D && !self.means()[0])?;
        let learnt = estimate.covariance.get(2 * D, 2 * D)?.sqrt();
        let Config { bias_sigma, common_bias_sigma, .. } = self.config;
        Some(learnt.hypot(bias_sigma * T::HALF).min(common_bias_sigma))
    }

    /// Health at `time_us` if this common bias is considered.
    pub(crate) fn health_beside(&self, common: Common<T>, time_us: u64) -> Health<T> {
        let place = self.estimate().and_then(|estimate| {
            let variances = estimate.covariance.variances();
            let coordinates = variances.iter().take(D);
            let velocity = self.velocity()?;
            let speed = T::norm(velocity.as_array());
            Some(Place {
                position: self.position()?,
                variance: coordinates.fold(T::ZERO, |sum, &variance| sum + variance),
                speed_squared: speed * speed,
                mirror: self.across_in_room().map(|across| T::norm(across.as_array())),
                common,
            })
        });
        let still = self.is_still(time_us);
        let (of, heard) = ((&self.counters, &self.config), (&*self.links, &self.pace));
        health::health(of, heard, place, time_us, still)
    }
}
