use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::blocks::Mapped;
use crate::moments::mean;
use crate::offspring;
use crate::sequence::{Steps, placed};
use crate::weights::Weights;
use crate::{Error, Likelihood, Moments, Region, Resample, Start, Update};

/// A weighted cloud of up to N states of D coordinates.
///
/// States are stored coordinate by coordinate, and weights as logarithms, the largest of them zero: N·(4·D + 8)
/// bytes in single precision. Every step is O(N) and allocates nothing.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Particles<T, const D: usize, const N: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays::rows"))]
    pub(crate) states: [[T; N]; D],
    pub(crate) weights: Weights<T, N>,
    /// Buffer for integer weights, then numbers of offspring; or for occupied bins.
    #[cfg_attr(feature = "serde", serde(skip, default = "no_scratch"))]
    pub(crate) scratch: [u32; N],
}

impl<T: Scalar, const D: usize, const N: usize> Particles<T, D, N> {
    const CAPACITY: usize = {
        assert!(0 < D, "a state has at least one coordinate");
        assert!(0 < N && N <= 1 << 20, "resampling is exact for up to 2²⁰ particles");
        N
    };

    /// N particles that fill a region.
    #[inline]
    pub fn new<R: Rng + ?Sized>(start: Start, region: &Region<T, D>, rng: &mut R) -> Self {
        let mut particles = Self::all_at(region.low());
        particles.spread(start, region, rng);
        particles
    }

    /// `count` particles that fill a region, of the N that there is room for.
    ///
    /// # Errors
    /// [`Error::NotPositive`] if `count` is zero, [`Error::TooMany`] if it is above N.
    #[inline]
    pub fn with_count<R: Rng + ?Sized>(
        count: usize,
        start: Start,
        region: &Region<T, D>,
        rng: &mut R,
    ) -> Result<Self, Error> {
        check(count, N)?;
        let mut particles = Self::all_at(region.low());
        particles.weights.equalise(count);
        particles.spread(start, region, rng);
        Ok(particles)
    }

    /// N particles of equal weight, all in one state.
    #[inline]
    pub fn all_at(state: &[T; D]) -> Self {
        Self {
            states: state.map(|coordinate| [coordinate; N]),
            weights: Weights::equal(Self::CAPACITY),
            scratch: [0; N],
        }
    }

    /// Fills a region anew and makes all weights equal: after [`Error::Degenerate`], when the state may be
    /// anywhere in the region. The number of particles is kept.
    #[inline]
    pub fn spread<R: Rng + ?Sized>(&mut self, start: Start, region: &Region<T, D>, rng: &mut R) {
        let (low, width) = (region.low(), region.width());
        let steps = Steps::of(self.len());
        for index in 0..self.weights.count() {
            let place = placed(start.point(index as u32, steps, rng), low, &width);
            self.put(index, &place);
        }
        self.weights.equalise(self.len());
    }

    /// The number of particles.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.weights.count()
    }

    /// Always false: there is at least one particle.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The state of a particle; `None` beyond the last one.
    #[inline(always)]
    pub fn state(&self, index: usize) -> Option<[T; D]> {
        (index < self.len()).then(|| self.at(index))
    }

    /// Logarithms of the weights; the largest is zero, and that of a weight of zero is −∞ (the lower limit in fixed
    /// point).
    #[inline(always)]
    pub fn log_weights(&self) -> &[T] {
        self.weights.logs()
    }

    /// The normalised weight of a particle, so that all sum up to one; `None` beyond the last particle.
    #[inline]
    pub fn weight(&self, index: usize) -> Option<T> {
        (index < self.len()).then(|| self.weights.of(index) / self.weights.sum())
    }

    /// Effective number of particles (Σw)²/Σw².
    #[inline]
    pub fn effective(&self) -> T {
        self.weights.effective()
    }

    /// Multiplies the weight of each particle by the likelihood of a measurement, given `log_likelihood` of its state.
    ///
    /// A likelihood that is not a number counts as zero.
    ///
    /// # Errors
    /// [`Error::Degenerate`] if no particle explains the measurement; nothing has changed then.
    #[inline(always)]
    pub fn update(&mut self, log_likelihood: impl Fn([T; D]) -> T) -> Result<Update<T>, Error> {
        self.weights.update(&self.states, log_likelihood)
    }

    /// [`Particles::update`] with a likelihood that is inlined: with feature `vectors` on the widest vectors of the
    /// processor, with the same result on all.
    ///
    /// # Errors
    /// As [`Particles::update`].
    #[inline(always)]
    pub fn weigh(&mut self, likelihood: &impl Likelihood<T, D>) -> Result<Update<T>, Error> {
        self.weights.weigh(&self.states, likelihood)
    }

    /// Replaces the particles by their offspring, of equal weight.
    ///
    /// # Errors
    /// None for any cloud, as at least one weight is positive; nothing would have changed then.
    #[inline]
    pub fn resample<R: Rng + ?Sized>(
        &mut self,
        resampler: impl Resample,
        rng: &mut R,
    ) -> Result<(), Error> {
        self.resample_to(self.len(), resampler, rng)
    }

    /// Replaces the particles by `count` offspring of equal weight; see [`kld_count`](crate::kld_count).
    ///
    /// # Errors
    /// [`Error::NotPositive`] if `count` is zero, [`Error::TooMany`] if it is above N. Nothing has changed then.
    #[inline]
    pub fn resample_to<R: Rng + ?Sized>(
        &mut self,
        count: usize,
        resampler: impl Resample,
        rng: &mut R,
    ) -> Result<(), Error> {
        check(count, N)?;
        let before = self.len();
        for index in 0..before.min(N) {
            self.scratch[index] = offspring::part(self.weights.of(index), offspring::bits(N));
        }
        let parts = self.scratch.get_mut(..before).ok_or(Error::TooMany)?;
        offspring::count(resampler, parts, count as u32, rng)?;
        self.multiply(before, count);
        self.weights.equalise(count);
        Ok(())
    }

    /// Copies the additional offspring of each particle into places below `after` whose particles have no offspring.
    fn multiply(&mut self, before: usize, after: usize) {
        let (before, after) = (before.min(N), after.min(N));
        let mut free = 0;
        for index in 0..before {
            // One offspring stays in the particle's own place.
            let stays = u32::from(index < after);
            for _ in stays..self.scratch[index] {
                while free < before && self.scratch[free] > 0 {
                    free += 1;
                }
                if free >= after {
                    return;
                }
                for states in &mut self.states {
                    states[free] = states[index];
                }
                free += 1;
            }
        }
    }

    /// Weighted mean and covariance of the states.
    #[inline]
    pub fn moments(&self) -> Moments<T, D> {
        Moments::of(&self.weights, &self.states)
    }

    /// Weighted mean and covariance of a function of the state, such as some of its coordinates.
    #[inline(always)]
    pub fn moments_of<const K: usize>(&self, of: impl Fn([T; D]) -> [T; K]) -> Moments<T, K> {
        Moments::of(&self.weights, &Mapped { points: &self.states, of })
    }

    /// Weighted mean of a function of the state: [`Particles::moments_of`] without the covariance.
    #[inline(always)]
    pub fn mean_of<const K: usize>(&self, of: impl Fn([T; D]) -> [T; K]) -> [T; K] {
        let first = of(self.at(0));
        mean(&self.weights, &Mapped { points: &self.states, of }, first)
    }

    /// The state of a particle; zeros beyond the last place.
    #[inline(always)]
    pub(crate) fn at(&self, index: usize) -> [T; D] {
        let mut state = [T::ZERO; D];
        for (coordinate, axis) in state.iter_mut().zip(&self.states) {
            if let Some(&value) = axis.get(index) {
                *coordinate = value;
            }
        }
        state
    }

    /// Sets the state of a particle; has no effect beyond the last place.
    #[inline(always)]
    pub(crate) fn put(&mut self, index: usize, state: &[T; D]) {
        for (axis, &coordinate) in self.states.iter_mut().zip(state) {
            if let Some(value) = axis.get_mut(index) {
                *value = coordinate;
            }
        }
    }
}

/// Default of the buffer for resampling, which is not stored.
#[cfg(feature = "serde")]
fn no_scratch<const N: usize>() -> [u32; N] {
    [0; N]
}

/// Checks that `count` points are at least one and at most `most`.
pub(crate) fn check(count: usize, most: usize) -> Result<(), Error> {
    match count {
        0 => Err(Error::NotPositive),
        _ if count > most => Err(Error::TooMany),
        _ => Ok(()),
    }
}
