use heapless::Vec;
use kestirim_air_to_ground::{Channel, Likelihood, Measurement};
use kestirim_particle_filter::{Likelihood as _, Moments, PointMass, Region, Update};
use kestirim_scalar::Scalar;

use crate::level_step::health;
use crate::seen::Seen;
use crate::{Error, Health};

/// Depth below the largest log-density, 10, beyond which points are given up when the lattice is laid anew.
const DEPTH: f64 = 10.0;
/// The lattice is laid anew when its weight is on less than this share of its points.
const SHARE: f64 = 0.05;
/// A lattice that is still too coarse is laid anew at once, at most so often.
const ROUNDS: usize = 4;

/// Finds a user who stays where they are: the posterior on a lattice of L points, which is laid anew, more
/// finely, where the posterior is.
///
/// All measurements of a user who does not move stay informative: up to M of them are stored, and each new
/// lattice is weighed by all. Beyond M the lattice stays as it is. 4·L + 16·M bytes in single precision.
///
/// The state is the place (m, in the plane of the measurements); with D = 3 its third coordinate is by how much
/// (dB) the transmitter is weaker than the measurements assume.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, C: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>, C: serde::Deserialize<'de>"
    ))
)]
pub struct Locator<T, const L: usize, const M: usize, const D: usize = 2, C = Channel<T>> {
    channel: C,
    posterior: PointMass<T, D, L>,
    measurements: Vec<Measurement<T>, M>,
    /// Number of measurements that were not stored.
    unstored: u32,
}

impl<T, C, const L: usize, const M: usize, const D: usize> Locator<T, L, M, D, C>
where
    T: Scalar,
    C: Likelihood<T>,
{
    /// A user who is equally likely to be anywhere in a region.
    #[inline]
    pub fn new(channel: C, region: &Region<T, D>) -> Self {
        const { assert!(D == 2 || D == 3, "a place in the plane, and perhaps a level") };
        Self { channel, posterior: PointMass::new(region), measurements: Vec::new(), unstored: 0 }
    }

    /// The same with a lattice of `count` points.
    ///
    /// # Errors
    /// [`Error::Filter`] with `NotPositive` for none, with `TooMany` for more than L.
    #[inline]
    pub fn with_count(count: usize, channel: C, region: &Region<T, D>) -> Result<Self, Error> {
        let posterior = PointMass::with_count(count, region)?;
        Ok(Self { posterior, ..Self::new(channel, region) })
    }

    /// Takes in a measurement.
    ///
    /// # Errors
    /// [`Error::Filter`] if nothing in the region explains it; then nothing has changed.
    pub fn measure(&mut self, measurement: &Measurement<T>) -> Result<Update<T>, Error> {
        let update = self.posterior.weigh(&Seen { channel: &self.channel, measurement })?;
        if self.measurements.push(*measurement).is_err() {
            self.unstored = self.unstored.saturating_add(1);
        }
        if self.unstored == 0 {
            self.refine();
        }
        Ok(update)
    }

    fn refine(&mut self) {
        let few = T::from_binary(self.posterior.len() as i32, 0) * T::from_f64(SHARE);
        for _ in 0..ROUNDS {
            if self.posterior.effective() > few {
                return;
            }
            let Some(mut finer) = self.posterior.finer(T::from_f64(DEPTH)) else { return };
            for measurement in &self.measurements {
                // One at a time over all points, which is vector instructions, not all at a point.
                if finer.weigh(&Seen { channel: &self.channel, measurement }).is_err() {
                    // A lattice that cannot be laid anew is still a posterior.
                    return;
                }
            }
            self.posterior = finer;
        }
    }

    /// Posterior mean of the state and its uncertainty.
    #[inline]
    pub fn moments(&self) -> Moments<T, D> {
        self.posterior.moments()
    }

    /// The posterior on its lattice.
    #[inline]
    pub fn posterior(&self) -> &PointMass<T, D, L> {
        &self.posterior
    }

    /// Logarithm of the posterior's density at a state, without a constant, from the stored measurements.
    pub fn log_posterior(&self, state: &[T; D]) -> T {
        log_posterior(&self.channel, &self.measurements, state)
    }

    /// Whether a state belongs to the smallest region that holds the true one with this probability (0 to 1):
    /// where the density is highest. None once more than M measurements were taken in.
    pub fn credible(&self, state: &[T; D], probability: T) -> Option<bool> {
        if self.unstored > 0 {
            return None;
        }
        if !self.posterior.region().contains(state) {
            return Some(false);
        }
        // The lattice knows densities relative to that of its heaviest point.
        let density = |state| self.log_posterior(state);
        let heaviest = self.posterior.point(self.posterior.heaviest())?;
        let level = self.posterior.density_level(probability);
        Some(density(state) - density(&heaviest) >= level)
    }

    /// Whether the place can be relied upon: `innovations` where the levels of the stored measurements step
    /// ([`LevelStep`](crate::LevelStep)), seen from it.
    pub fn health(&self) -> Health {
        let mean = self.moments().mean();
        health(&self.measurements, [mean[0], mean[1]])
    }
}

/// The logarithm of the posterior's density, without a constant.
#[inline(always)]
fn log_posterior<T: Scalar, C: Likelihood<T>, const D: usize>(
    channel: &C,
    measurements: &[Measurement<T>],
    state: &[T; D],
) -> T {
    let mut sum = T::ZERO;
    for measurement in measurements {
        sum += Seen { channel, measurement }.logarithm(*state);
    }
    sum
}
