//! Health of a tracker.

use super::Tracker;
use crate::Health;
use crate::health::{self, Place};
use kestirim_scalar::{Components, Scalar};

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// Health of the tracker at `time_us`.
    pub fn health(&self, time_us: u64) -> Health<T> {
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
            })
        });
        let still = self.is_still(time_us);
        let (of, heard) = ((&self.counters, &self.config), (&*self.links, &self.pace));
        health::health(of, heard, place, time_us, still)
    }
}
