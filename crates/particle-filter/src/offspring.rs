use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::{Error, IntegerWeights, Resample};

/// Replaces integer weights by numbers of offspring that sum up to `draws`. O(N), in place, exact.
///
/// # Errors
/// Those of [`IntegerWeights::new`].
pub(crate) fn count<R: Rng + ?Sized>(
    resampler: impl Resample,
    weights: &mut [u32],
    draws: u32,
    rng: &mut R,
) -> Result<(), Error> {
    resampler.replace(IntegerWeights::new(weights, draws)?, rng);
    Ok(())
}

/// Number of bits by which weights are scaled, such that N of them times N fit into 63 bits.
pub(crate) const fn bits(count: usize) -> i32 {
    let doubled = 2 * (usize::BITS - count.leading_zeros()) as i32;
    if doubled > 31 { 62 - doubled } else { 31 }
}

/// Computes the number of offspring of each particle from its weight: `counts`, which sum up to their own number.
///
/// Weights need not sum up to one. They are represented by integers of 31 bits (fewer beyond 32 000 weights), so that
/// neither a cumulative sum nor its last index can be rounded wrongly, and all number types give the same draws;
/// a weight below 2⁻³¹ of the largest has no offspring.
///
/// # Errors
/// [`Error::NotFinite`] or [`Error::NotPositive`] if a weight is not finite or negative,
/// [`Error::Degenerate`] if all are zero, [`Error::TooMany`] if the slices differ in length or have more
/// than 2²⁰ entries. In all cases `counts` is untouched.
pub fn offspring<T: Scalar, R: Rng + ?Sized>(
    resampler: impl Resample,
    weights: &[T],
    counts: &mut [u32],
    rng: &mut R,
) -> Result<(), Error> {
    if counts.len() != weights.len() || counts.len() > 1 << 20 {
        return Err(Error::TooMany);
    }
    let largest = largest_of(weights)?;
    let (bits, divisor) = (bits(counts.len()), largest.divisor());
    if T::ONE.divided_by(divisor).is_finite() {
        for (count, weight) in counts.iter_mut().zip(weights) {
            *count = part(weight.divided_by(divisor), bits);
        }
    } else {
        // The reciprocal of a subnormal number overflows.
        for (count, &weight) in counts.iter_mut().zip(weights) {
            *count = part(weight / largest, bits);
        }
    }
    let draws = counts.len() as u32;
    count(resampler, counts, draws, rng)
}

/// The largest weight, provided that all are finite and not negative.
fn largest_of<T: Scalar>(weights: &[T]) -> Result<T, Error> {
    const LANES: usize = 8;
    let (mut largest, mut fine) = ([T::ZERO; LANES], [true; LANES]);
    for chunk in weights.chunks(LANES) {
        for ((largest, fine), &weight) in largest.iter_mut().zip(&mut fine).zip(chunk) {
            *largest = if weight > *largest { weight } else { *largest };
            *fine &= weight.is_finite() && weight >= T::ZERO;
        }
    }
    let largest = largest.into_iter().fold(T::ZERO, T::max);
    if fine == [true; LANES] {
        return if largest > T::ZERO { Ok(largest) } else { Err(Error::Degenerate) };
    }
    let negative = weights.iter().any(|weight| weight.is_finite() && *weight < T::ZERO);
    Err(if negative { Error::NotPositive } else { Error::NotFinite })
}

/// A weight in 0..=1 as an integer of `bits` bits.
#[inline(always)]
pub(crate) fn part<T: Scalar>(weight: T, bits: i32) -> u32 {
    weight.to_binary(-bits).max(0) as u32
}
