use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::Error;
use crate::uniform::Uniform;

/// By which law particles have offspring (the thesis' Tables 2.2 to 2.5). The expected number is always
/// N·w.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Resampler {
    /// N independent draws.
    Multinomial,
    /// ⌊N·w⌋ each, and the rest by independent draws.
    Residual,
    /// One draw in each N-th of the sum: within two of N·w.
    Stratified,
    /// One draw for all N-ths: within one of N·w. The thesis' choice, and the cheapest.
    #[default]
    Systematic,
}

/// Replaces integer weights by numbers of offspring, which sum up to `draws`. O(N), in place, exact.
///
/// # Errors
/// [`Error::Degenerate`] if all weights are zero, [`Error::TooMany`] if their sum times `draws` exceeds
/// 2⁶³ or there are more than 2²⁰ draws.
pub(crate) fn count<R: Rng + ?Sized>(
    resampler: Resampler,
    weights: &mut [u32],
    draws: u32,
    rng: &mut R,
) -> Result<(), Error> {
    let total: u64 = weights.iter().map(|&weight| u64::from(weight)).sum();
    if total == 0 {
        return Err(Error::Degenerate);
    }
    if draws > 1 << 20 || total.leading_zeros() + draws.leading_zeros() < 33 {
        return Err(Error::TooMany);
    }
    let shares = Shares::new(total, draws);
    match resampler {
        Resampler::Systematic => {
            let offset = scaled(total, rng.next_u32());
            one_in_each(weights, &shares, |_| offset);
        }
        Resampler::Stratified => {
            let (mut last, mut offset) = (u64::MAX, 0);
            one_in_each(weights, &shares, |stratum| {
                // Drawn anyway: a branch would be guessed wrongly every other time.
                let fresh = scaled(total, rng.next_u32());
                offset = if stratum == last { offset } else { fresh };
                last = stratum;
                offset
            });
        }
        Resampler::Multinomial => {
            independently(weights, draws, total, |weight| (0, u64::from(weight)), rng);
        }
        Resampler::Residual => {
            let whole: u64 = weights.iter().map(|&weight| shares.of(weight.into()).0).sum();
            let rest = draws.saturating_sub(whole as u32);
            // What is left over sums up to just so many shares.
            let mass = u64::from(rest) * total;
            independently(weights, rest, mass, |weight| shares.of(weight.into()), rng);
        }
    }
    Ok(())
}

/// One draw in each of the strata of equal weight, `offset` of a stratum from its beginning.
#[inline(always)]
fn one_in_each(weights: &mut [u32], shares: &Shares, mut offset: impl FnMut(u64) -> u64) {
    let (mut cumulative, mut before) = (0, 0);
    for weight in weights {
        cumulative += u64::from(*weight);
        let (strata, rest) = shares.of(cumulative);
        let drawn = strata + u64::from(offset(strata) < rest);
        *weight = (drawn - before) as u32;
        before = drawn;
    }
}

/// `draws` independent ones from what `split` leaves of each weight, and what it takes for certain. `mass`
/// is the sum of what it leaves.
#[inline(always)]
fn independently<R: Rng + ?Sized>(
    weights: &mut [u32],
    draws: u32,
    mass: u64,
    split: impl Fn(u32) -> (u64, u64),
    rng: &mut R,
) {
    let mut uniform = Uniform::new(draws);
    let places = Places::new(mass);
    let mut cumulative = 0;
    for weight in weights {
        let (certain, rest) = split(*weight);
        cumulative += rest;
        *weight = certain as u32 + uniform.below(places.of(cumulative), rng);
    }
}

/// Cumulated weights as 32-bit numbers.
struct Places {
    mass: u64,
    zeros: u32,
    reciprocal: u64,
}

impl Places {
    #[inline]
    fn new(mass: u64) -> Self {
        let zeros = mass.leading_zeros().min(63);
        let upper = ((mass << zeros) >> 32) + 1;
        Self { mass, zeros, reciprocal: (1 << 63) / upper }
    }

    /// 2³² · cumulative / mass, within two of it; of the whole mass, more than any number.
    #[inline(always)]
    fn of(&self, cumulative: u64) -> u32 {
        let place = (((cumulative << self.zeros) >> 32) * self.reciprocal) >> 31;
        if cumulative < self.mass { place.min(u64::from(u32::MAX)) as u32 } else { u32::MAX }
    }
}

/// value · fraction / 2³², rounded down.
#[inline(always)]
fn scaled(value: u64, fraction: u32) -> u64 {
    let fraction = u64::from(fraction);
    (value >> 32) * fraction + (((value & 0xFFFF_FFFF) * fraction) >> 32)
}

/// Division of cumulated weights by one share, total/draws: a multiplication, since the divisor stays.
struct Shares {
    total: u64,
    draws: u64,
    zeros: u32,
    /// draws · 2⁴³ / (the uppermost 32 bits of the total, rounded up).
    reciprocal: u64,
}

impl Shares {
    #[inline]
    fn new(total: u64, draws: u32) -> Self {
        let zeros = total.leading_zeros();
        let upper = ((total << zeros) >> 32) + 1;
        let draws = u64::from(draws);
        Self { total, draws, zeros, reciprocal: (draws << 43) / upper }
    }

    /// How many whole shares there are in a weight, and draws times what remains.
    #[inline(always)]
    fn of(&self, weight: u64) -> (u64, u64) {
        // Right, or one too small: with up to 2²⁰ draws the error is below 2⁻¹⁰.
        let estimate = (((weight << self.zeros) >> 32) * self.reciprocal) >> 43;
        let rest = (weight * self.draws).wrapping_sub(estimate * self.total);
        let short = rest >= self.total;
        (estimate + u64::from(short), if short { rest - self.total } else { rest })
    }
}

/// By how many bits weights are multiplied, so that N of them times N fit into 63.
pub(crate) const fn bits(count: usize) -> i32 {
    let doubled = 2 * (usize::BITS - count.leading_zeros()) as i32;
    if doubled > 31 { 62 - doubled } else { 31 }
}

/// How many offspring each of some weights has: `counts`, which sum up to their own number.
///
/// Weights need not sum up to one. Integers of 31 bits stand for them (fewer beyond 32 000 weights), so that
/// neither a cumulative sum nor its last index can be rounded wrongly, and every number type draws alike;
/// a weight below 2⁻³¹ of the largest has no offspring.
///
/// # Errors
/// [`Error::NotFinite`] or [`Error::NotPositive`] if a weight is not finite or negative,
/// [`Error::Degenerate`] if all are zero, [`Error::TooMany`] if the slices differ in length or have more
/// than 2²⁰ entries. Then `counts` is as it was.
pub fn offspring<T: Scalar, R: Rng + ?Sized>(
    resampler: Resampler,
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

/// The largest weight, if all of them are weights.
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

/// A weight of up to one as an integer.
#[inline(always)]
pub(crate) fn part<T: Scalar>(weight: T, bits: i32) -> u32 {
    weight.to_binary(-bits).max(0) as u32
}
