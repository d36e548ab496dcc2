//! The number of particles according to Fox's KLD sampling (Kullback–Leibler divergence).

use kestirim_scalar::Scalar;

use crate::{Error, Particles};

/// The number of particles that keeps the Kullback–Leibler divergence from the true posterior below `epsilon` with
/// the confidence whose normal quantile is `z` (2.33 for 99 %), if the posterior occupies `bins` bins.
/// It is at least one and never above `most`.
///
/// D. Fox, "Adapting the sample size in particle filters through KLD-sampling", Int. J. of Robotics Research
/// 22(12), 2003, eq. 13 (Wilson and Hilferty's approximation of χ²).
///
/// # Errors
/// [`Error::NotPositive`] if `epsilon` is not above zero, [`Error::NotFinite`] if `epsilon` or `z` is not finite.
pub fn kld_count<T: Scalar>(bins: usize, epsilon: T, z: T, most: usize) -> Result<usize, Error> {
    if !T::all_finite(&[epsilon, z]) {
        return Err(Error::NotFinite);
    }
    if epsilon <= T::ZERO {
        return Err(Error::NotPositive);
    }
    let Some(free) = bins.checked_sub(1).filter(|&free| free > 0) else { return Ok(1.min(most)) };
    let free = T::from_binary(free as i32, 0);
    let ninths = T::TWO / (T::from_f64(9.0) * free);
    let root = T::ONE - ninths + ninths.sqrt() * z;
    let count = free / (epsilon + epsilon) * (root * root * root);
    Ok(usize::try_from(count.to_binary(0)).unwrap_or(0).clamp(1, most.max(1)))
}

impl<T: Scalar, const D: usize, const N: usize> Particles<T, D, N> {
    /// The number of bins with these sides that hold a particle of relevant weight (1/1000 of the largest).
    ///
    /// Bins are hashed into 32·N bits, so that of k bins about k²/(64·N) are not told apart. To be called between
    /// update and resampling.
    ///
    /// # Errors
    /// [`Error::NotPositive`] if a side is not above zero.
    pub fn occupied_bins(&mut self, sides: &[T; D]) -> Result<usize, Error> {
        if !sides.iter().all(|side| *side > T::ZERO) {
            return Err(Error::NotPositive);
        }
        self.scratch = [0; N];
        let least = -T::from_f64(6.9);
        let bits = u32::try_from(N).unwrap_or(u32::MAX).saturating_mul(32);
        let mut bins = 0;
        for index in 0..self.weights.count() {
            if self.weights.logs().get(index).is_none_or(|&log| log < least) {
                continue;
            }
            let mut hash = 0_u32;
            for (coordinate, &side) in self.at(index).into_iter().zip(sides) {
                // Offset by one half, so that borders of bins do not coincide with the points of a regular start.
                let bin = (coordinate / side + T::HALF).to_binary(0) as u32;
                // Knuth's multiplicative hash; the rotation lets later coordinates reach all bits.
                hash = (hash.rotate_left(13) ^ bin).wrapping_mul(2_654_435_769);
            }
            let bit = (u64::from(hash) * u64::from(bits)) >> 32;
            if let Some(word) = self.scratch.get_mut((bit / 32) as usize) {
                let mask = 1 << (bit % 32);
                bins += usize::from(*word & mask == 0);
                *word |= mask;
            }
        }
        Ok(bins)
    }
}
