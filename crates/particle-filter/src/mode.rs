//! The mode of a cloud of particles.

use kestirim_scalar::Scalar;

use crate::{Error, Particles};

/// Number of particles tried as starting points of the search for the mode.
const CANDIDATES: usize = 32;
/// Number of mean-shift steps: converging linearly, this many get within a hundredth of the bandwidth.
const STEPS: usize = 12;

impl<T: Scalar, const D: usize, const N: usize> Particles<T, D, N> {
    /// The highest peak of the density, smoothed with the biweight kernel of these half-widths. For a
    /// posterior with several peaks this is the main one, while the mean lies between them.
    ///
    /// Starts at the densest of the heaviest and up to 32 other particles, and proceeds by mean shift with the weights of Epanechnikov's
    /// kernel, which climbs the density of the biweight kernel: O(57·N).
    ///
    /// # Errors
    /// [`Error::NotPositive`] if a half-width is not above zero.
    pub fn mode(&self, half_widths: &[T; D]) -> Result<[T; D], Error> {
        if !half_widths.iter().all(|width| *width > T::ZERO) {
            return Err(Error::NotPositive);
        }
        let divisors = half_widths.map(Scalar::divisor);
        let kernel = |centre: &[T; D], weight: T, state: [T; D]| {
            let mut offset = [T::ZERO; D];
            for axis in 0..D {
                // Beyond two half-widths the kernel is zero anyway, and clamping keeps the square from overflowing.
                let distance = (state[axis] - centre[axis]).divided_by(divisors[axis]);
                offset[axis] = distance.clamp(-T::TWO, T::TWO);
            }
            let height = (T::ONE - T::dot(&offset, &offset)).max(T::ZERO);
            (height * weight, offset)
        };
        let density = |centre: &[T; D]| {
            let [[sum]] = self
                .weights
                .sums(&self.states, |weight, state| [[(kernel(centre, weight, state).0, T::ONE)]]);
            sum
        };
        let mut mode = self.at(self.weights.heaviest().min(N - 1));
        let mut highest = density(&mode);
        let stride = self.len().div_ceil(CANDIDATES).max(1);
        for index in (0..self.weights.count()).step_by(stride) {
            let candidate = self.at(index);
            let height = density(&candidate);
            if height > highest {
                (mode, highest) = (candidate, height);
            }
        }
        for _ in 0..STEPS {
            let heights = density(&mode).max(T::EPSILON).divisor();
            let [shift] = self.weights.sums(&self.states, |weight, state| {
                let (height, offset) = kernel(&mode, weight, state);
                [offset.map(|offset| (height, offset))]
            });
            for axis in 0..D {
                mode[axis] += shift[axis].divided_by(heights) * half_widths[axis];
            }
        }
        Ok(mode)
    }
}
