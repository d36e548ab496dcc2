//! Health of a tracker.

use super::{LOST_US, Tracker};
use crate::health::{self, Common, Place};
use crate::measurement::Standstill;
use crate::{Config, Health, motion};
use kestirim_kalman::Gaussian;
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
        let place = self.later(time_us).and_then(|estimate| {
            let position = self.position()?;
            let there = estimate.mean.as_array().iter().zip(position.as_array());
            let moved = there.map(|(&there, &here)| (there - here) * (there - here));
            let variances = estimate.covariance.variances();
            let squares = variances.iter().take(D).copied().chain(moved);
            let velocity = self.velocity()?;
            let speed = T::norm(velocity.as_array());
            Some(Place {
                position,
                variance: squares.fold(T::ZERO, |sum, square| sum + square),
                speed_squared: speed * speed,
                mirror: self.across_in_room().map(|across| T::norm(across.as_array())),
                common,
            })
        });
        let still = self.is_still(time_us);
        let (of, heard) = ((&self.counters, &self.config), (&*self.links, &self.pace));
        health::health(of, heard, place, time_us, still)
    }

    /// The estimate predicted to `time_us` without another sample; `None` if it has become useless by then.
    fn later(&self, time_us: u64) -> Option<Gaussian<T, N>> {
        let mut estimate = *self.estimate()?;
        let elapsed = time_us.saturating_sub(self.time_us);
        if elapsed == 0 {
            return Some(estimate);
        }
        if elapsed > LOST_US {
            return None;
        }
        let still = self.is_still(time_us) && Standstill::agrees::<T, D, N>(&estimate);
        let interval = T::from_micro(elapsed as i32);
        motion::advance::<T, D, N>(&mut estimate, &self.config, interval, still, None).ok()?;
        self.is_known(&estimate).then_some(estimate)
    }
}
