use heapless::Vec;
use kestirim_air_to_ground::{Channel, Likelihood, Measurement};
use kestirim_particle_filter::{Likelihood as _, Moments, PointMass, Region, Update};
use kestirim_scalar::Scalar;

use crate::level_step::health;
use crate::seen::{Seen, SeenAgain};
use crate::{Error, Health};

/// Points whose log-density is this far below the largest are dropped when the lattice is refined.
const DEPTH: f64 = 10.0;
/// The lattice is refined when its effective number of points falls to this fraction of them.
const SHARE: f64 = 0.05;
/// Largest number of refinements in a row, while the lattice is still too coarse.
const ROUNDS: usize = 4;

/// Locates a user who does not move: the posterior on a lattice of L points, which is refined where the posterior is
/// concentrated.
///
/// All measurements of a stationary user remain informative: up to M of them are stored, and each new lattice is
/// weighted with all of them. Beyond M, the lattice is no longer refined. 4·L + 16·M bytes in single precision.
///
/// The state is the place (m, in the plane of the measurements); with D = 3, its third coordinate is the amount (dB)
/// by which the transmitter is weaker than the measurements assume.
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
    /// Number of measurements for which there was no room.
    unstored: u32,
}

impl<T, C, const L: usize, const M: usize, const D: usize> Locator<T, L, M, D, C>
where
    T: Scalar,
    C: Likelihood<T>,
{
    /// Creates a locator for a user who is equally likely to be anywhere in a region.
    #[inline]
    pub fn new(channel: C, region: &Region<T, D>) -> Self {
        const { assert!(D == 2 || D == 3, "a place in the plane, and perhaps a level") };
        Self { channel, posterior: PointMass::new(region), measurements: Vec::new(), unstored: 0 }
    }

    /// Creates a locator as [`Locator::new`] does, with a lattice of `count` points.
    ///
    /// # Errors
    /// [`Error::Filter`] with `NotPositive` if `count` is zero, with `TooMany` if it exceeds L.
    #[inline]
    pub fn with_count(count: usize, channel: C, region: &Region<T, D>) -> Result<Self, Error> {
        let posterior = PointMass::with_count(count, region)?;
        Ok(Self { posterior, ..Self::new(channel, region) })
    }

    /// Adds a measurement.
    ///
    /// # Errors
    /// [`Error::Filter`] if nothing in the region explains it; nothing is changed.
    pub fn measure(&mut self, measurement: &Measurement<T>) -> Result<Update<T>, Error> {
        let update =
            weigh(&mut self.posterior, &self.channel, measurement, self.measurements.is_empty())?;
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
            for (index, measurement) in self.measurements.iter().enumerate() {
                // Measurement by measurement over all points, which vectorises, rather than point by point.
                if weigh(&mut finer, &self.channel, measurement, index == 0).is_err() {
                    // If it cannot be refined, the present lattice is still a posterior.
                    return;
                }
            }
            self.posterior = finer;
        }
    }

    /// The posterior mean of the state and its uncertainty.
    #[inline]
    pub fn moments(&self) -> Moments<T, D> {
        self.posterior.moments()
    }

    /// The posterior on its lattice.
    #[inline]
    pub fn posterior(&self) -> &PointMass<T, D, L> {
        &self.posterior
    }

    /// Logarithm of the posterior density at a state, up to a constant, from the stored measurements.
    pub fn log_posterior(&self, state: &[T; D]) -> T {
        log_posterior(&self.channel, &self.measurements, state)
    }

    /// Whether a state belongs to the highest-density region that contains the true state with this probability (0 to
    /// 1). `None` once there were more than M measurements.
    pub fn credible(&self, state: &[T; D], probability: T) -> Option<bool> {
        if self.unstored > 0 {
            return None;
        }
        if !self.posterior.region().contains(state) {
            return Some(false);
        }
        // The lattice stores densities relative to that of its heaviest point.
        let density = |state| self.log_posterior(state);
        let heaviest = self.posterior.point(self.posterior.heaviest())?;
        let level = self.posterior.density_level(probability);
        Some(density(state) - density(&heaviest) >= level)
    }

    /// Whether the place is reliable: reports `innovations` if the levels of the stored measurements show a step
    /// ([`LevelStep`](crate::LevelStep)) as seen from it.
    pub fn health(&self) -> Health {
        let mean = self.moments().mean();
        health(&self.measurements, [mean[0], mean[1]])
    }
}

impl<T, C, const L: usize, const M: usize> Locator<T, L, M, 3, C>
where
    T: Scalar,
    C: Likelihood<T>,
{
    /// [`Locator::log_posterior`] at one place with several levels (dB): what depends on the place alone is computed once for
    /// each measurement.
    pub fn log_posterior_of_levels<const K: usize>(
        &self,
        place: [T; 2],
        levels: &[T; K],
    ) -> [T; K] {
        let mut sums = [T::ZERO; K];
        for (index, measurement) in self.measurements.iter().enumerate() {
            for (sum, level) in sums.iter_mut().zip(levels) {
                let measurement = measurement.less(*level);
                *sum += if index == 0 {
                    self.channel.log_likelihood(&measurement, place)
                } else {
                    self.channel.log_likelihood_again(&measurement, place)
                };
            }
        }
        sums
    }
}

/// Weighs the points of a lattice by a measurement. Points that the first one has shown to be impossible stay so.
#[inline(always)]
fn weigh<T: Scalar, C: Likelihood<T>, const L: usize, const D: usize>(
    lattice: &mut PointMass<T, D, L>,
    channel: &C,
    measurement: &Measurement<T>,
    is_first: bool,
) -> Result<Update<T>, kestirim_particle_filter::Error> {
    let seen = Seen { channel, measurement };
    if is_first || !C::IS_LESS_AGAIN {
        lattice.weigh(&seen)
    } else {
        lattice.weigh(&SeenAgain(seen))
    }
}

/// The logarithm of the posterior density, up to a constant.
#[inline(always)]
fn log_posterior<T: Scalar, C: Likelihood<T>, const D: usize>(
    channel: &C,
    measurements: &[Measurement<T>],
    state: &[T; D],
) -> T {
    let mut measurements = measurements.iter().map(|measurement| Seen { channel, measurement });
    let Some(first) = measurements.next() else { return T::ZERO };
    let mut sum = first.logarithm(*state);
    for seen in measurements {
        sum += SeenAgain(seen).logarithm(*state);
    }
    sum
}
