//! Motion, and measures against impoverishment: jitter, a kernel that shrinks with the cloud, and Metropolis moves.

use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::random::{normal_point, uniform};
use crate::{Error, Particles};

/// Number of proposals evaluated together.
const BLOCK: usize = 16;

impl<T: Scalar, const D: usize, const N: usize> Particles<T, D, N> {
    /// Moves each particle by `motion`, a function of its state and K nearly normal random numbers (zero mean, variance
    /// one, within ±3).
    #[inline(always)]
    pub fn predict<const K: usize, R: Rng + ?Sized>(
        &mut self,
        motion: impl Fn([T; D], [T; K]) -> [T; D],
        rng: &mut R,
    ) {
        for index in 0..self.weights.count() {
            let noise = normal_point(rng);
            let state = motion(self.at(index), noise);
            self.put(index, &state);
        }
    }

    /// Adds noise of these standard deviations to each particle: the thesis' jitter, line 15 of Table 2.1.
    ///
    /// The noise never shrinks, so in the end the cloud is as wide as the noise of all steps.
    #[inline]
    pub fn jitter<R: Rng + ?Sized>(&mut self, deviation: &[T; D], rng: &mut R) {
        for index in 0..self.weights.count() {
            for axis in 0..D {
                let noise = crate::random::nearly_normal::<T>(rng.next_u32());
                self.states[axis][index] += noise * deviation[axis];
            }
        }
    }

    /// Moves each particle towards the mean and adds noise of the cloud's own shape, which shrinks with it, such that
    /// mean and covariance are preserved: Liu and West's kernel with Silverman's width times `scale` (1 suits a
    /// normal posterior; rings and crescents need less). To be called after resampling.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::NotPositive`] if `scale` is not finite or not positive; nothing has changed
    /// then.
    #[inline]
    pub fn regularise<R: Rng + ?Sized>(&mut self, scale: T, rng: &mut R) -> Result<(), Error> {
        if !scale.is_finite() {
            return Err(Error::NotFinite);
        }
        if scale <= T::ZERO {
            return Err(Error::NotPositive);
        }
        let width = (scale * silverman::<T, D>(self.len())).min(T::ONE);
        let shrinkage = (T::ONE - width * width).max(T::ZERO).sqrt();
        let moments = self.moments();
        let (mean, factor) = (moments.mean(), moments.factor());
        for index in 0..self.weights.count() {
            let noise: [T; D] = normal_point(rng);
            for axis in 0..D {
                let kernel = T::dot(&factor[axis], &noise) * width;
                let from_mean = self.states[axis][index] - mean[axis];
                self.states[axis][index] = mean[axis] + from_mean * shrinkage + kernel;
            }
        }
        Ok(())
    }

    /// Makes one Metropolis move of each particle: a step of the cloud's own shape times `scale`, accepted by
    /// the ratio of the posteriors. Returns the number of accepted moves.
    ///
    /// `log_posterior` of a state may omit a constant; for a static problem it is the sum over the stored
    /// measurements. After resampling, a few moves diversify the offspring of each particle without
    /// widening the posterior (Gilks and Berzuini's resample–move). The best scale is about 2.4/√D.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if `scale` is not finite; nothing has changed then.
    #[inline(always)]
    pub fn metropolis<R: Rng + ?Sized>(
        &mut self,
        scale: T,
        log_posterior: impl Fn([T; D]) -> T,
        rng: &mut R,
    ) -> Result<usize, Error> {
        if !scale.is_finite() {
            return Err(Error::NotFinite);
        }
        let moments = self.moments();
        let factor = moments.factor();
        let (count, mut taken) = (self.weights.count(), 0);
        let mut base = 0;
        while base < count {
            let end = (base + BLOCK).min(count);
            let mut proposals = [[T::ZERO; D]; BLOCK];
            for (proposal, index) in proposals.iter_mut().zip(base..end) {
                let (state, noise) = (self.at(index), normal_point::<T, D, R>(rng));
                for axis in 0..D {
                    proposal[axis] = state[axis] + T::dot(&factor[axis], &noise) * scale;
                }
            }
            let mut gains = [T::ZERO; BLOCK];
            for ((gain, proposal), index) in gains.iter_mut().zip(&proposals).zip(base..end) {
                *gain = log_posterior(*proposal) - log_posterior(self.at(index));
            }
            for ((gain, proposal), index) in gains.iter().zip(&proposals).zip(base..end) {
                if gain.exp() > uniform::<T>(rng.next_u32()) {
                    self.put(index, proposal);
                    taken += 1;
                }
            }
            base = end;
        }
        Ok(taken)
    }
}

/// Silverman's width of a normal kernel in units of the standard deviation: (4/(n·(D + 2)))^(1/(D + 4)).
fn silverman<T: Scalar, const D: usize>(count: usize) -> T {
    let number = |value: usize| T::from_binary(value as i32, 0);
    // Two logarithms, since the product may exceed a fixed-point format.
    let log = number(4).ln() - number(count).ln() - number(D + 2).ln();
    (log / number(D + 4)).exp()
}
