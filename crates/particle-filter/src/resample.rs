//! Resampling schemes.

use rand_core::Rng;

use crate::Error;
use crate::uniform::Uniform;

/// A resampling scheme, which chooses the number of offspring of each particle.
///
/// The expected number of offspring should be proportional to the weight. [`Resampler`] chooses among the schemes of
/// this crate at run time. Each of them is also a type of its own, and any other scheme can be passed to
/// [`Particles::resample`](crate::Particles::resample).
pub trait Resample {
    /// Replaces each weight by its number of offspring. They should sum up to the number of draws: where offspring are
    /// missing, particles stay where they are; surplus offspring are left out.
    fn replace<R: Rng + ?Sized>(self, weights: IntegerWeights<'_>, rng: &mut R);
}

/// Weights of particles as integers, to be replaced by numbers of offspring: not all zero, and few and small enough
/// for exact arithmetic.
#[derive(Debug)]
pub struct IntegerWeights<'a> {
    weights: &'a mut [u32],
    draws: u32,
    /// Computed before a scheme is chosen, once for all schemes.
    shares: Shares,
}

impl<'a> IntegerWeights<'a> {
    /// Weights among which `draws` offspring are to be distributed.
    ///
    /// # Errors
    /// [`Error::Degenerate`] if all weights are zero, [`Error::TooMany`] if their sum times `draws` exceeds
    /// 2⁶³ or there are more than 2²⁰ draws.
    #[inline(always)]
    pub fn new(weights: &'a mut [u32], draws: u32) -> Result<Self, Error> {
        let total: u64 = weights.iter().map(|&weight| u64::from(weight)).sum();
        if total == 0 {
            return Err(Error::Degenerate);
        }
        if draws > 1 << 20 || total.leading_zeros() + draws.leading_zeros() < 33 {
            return Err(Error::TooMany);
        }
        Ok(Self { weights, draws, shares: Shares::new(total, draws) })
    }

    /// The weights, their sum, and the number of draws.
    #[inline(always)]
    pub fn into_parts(self) -> (&'a mut [u32], u64, u32) {
        (self.weights, self.shares.total, self.draws)
    }
}

/// Multinomial resampling: N independent draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Multinomial;

/// Residual resampling: ⌊N·w⌋ offspring each, and the rest by independent draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Residual;

/// Stratified resampling: an independent draw in each N-th of the cumulative weight. Counts are within two of N·w.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stratified;

/// Systematic resampling: one draw for all N-ths of the cumulative weight. Counts are within one of N·w. The thesis'
/// choice, and the cheapest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Systematic;

/// A choice among the resampling schemes of this crate (the thesis' Tables 2.2 to 2.5) at run time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Resampler {
    /// Independent draws: see [`struct@Multinomial`].
    Multinomial,
    /// Whole shares, and draws for the rest: see [`struct@Residual`].
    Residual,
    /// A draw in each stratum: see [`struct@Stratified`].
    Stratified,
    /// One draw for all strata: see [`struct@Systematic`].
    #[default]
    Systematic,
}

impl Resample for Resampler {
    #[inline(always)]
    fn replace<R: Rng + ?Sized>(self, weights: IntegerWeights<'_>, rng: &mut R) {
        match self {
            Self::Multinomial => Multinomial.replace(weights, rng),
            Self::Residual => Residual.replace(weights, rng),
            Self::Stratified => Stratified.replace(weights, rng),
            Self::Systematic => Systematic.replace(weights, rng),
        }
    }
}

impl Resample for Multinomial {
    #[inline(always)]
    fn replace<R: Rng + ?Sized>(self, weights: IntegerWeights<'_>, rng: &mut R) {
        let (weights, total, draws) = weights.into_parts();
        independently(weights, draws, total, |weight| (0, u64::from(weight)), rng);
    }
}

impl Resample for Residual {
    #[inline(always)]
    fn replace<R: Rng + ?Sized>(self, weights: IntegerWeights<'_>, rng: &mut R) {
        let IntegerWeights { weights, draws, shares } = weights;
        let whole: u64 = weights.iter().map(|&weight| shares.of(weight.into()).0).sum();
        let rest = draws.saturating_sub(whole as u32);
        // The remainders of all weights sum up to exactly `rest` shares.
        let mass = u64::from(rest) * shares.total;
        independently(weights, rest, mass, |weight| shares.of(weight.into()), rng);
    }
}

impl Resample for Stratified {
    #[inline(always)]
    fn replace<R: Rng + ?Sized>(self, weights: IntegerWeights<'_>, rng: &mut R) {
        let IntegerWeights { weights, shares, .. } = weights;
        let (mut last, mut offset) = (u64::MAX, 0);
        one_in_each(weights, &shares, |stratum| {
            // Drawn unconditionally: a branch would be mispredicted every other time.
            let fresh = scaled(shares.total, rng.next_u32());
            offset = if stratum == last { offset } else { fresh };
            last = stratum;
            offset
        });
    }
}

impl Resample for Systematic {
    #[inline(always)]
    fn replace<R: Rng + ?Sized>(self, weights: IntegerWeights<'_>, rng: &mut R) {
        let IntegerWeights { weights, shares, .. } = weights;
        let offset = scaled(shares.total, rng.next_u32());
        one_in_each(weights, &shares, |_| offset);
    }
}

/// Makes one draw in each of the strata of equal weight, at `offset` from the beginning of the stratum.
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

/// Distributes `draws` independent draws. `split` divides each weight into a certain number of offspring and a
/// remainder to draw from; `mass` is the sum of the remainders.
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

/// Conversion of cumulative weights to 32-bit numbers.
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

    /// 2³² · cumulative / mass, with an error of up to two; for the whole mass, a number above any draw.
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

/// Division of cumulative weights by one share, total/draws: a multiplication, as the divisor stays the same.
#[derive(Debug)]
struct Shares {
    total: u64,
    draws: u64,
    zeros: u32,
    /// draws · 2⁴³ / (the upper 32 bits of the total, rounded up).
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

    /// The number of whole shares in a weight, and draws times the remainder.
    #[inline(always)]
    fn of(&self, weight: u64) -> (u64, u64) {
        // Exact or one too small: with up to 2²⁰ draws the error is below 2⁻¹⁰.
        let estimate = (((weight << self.zeros) >> 32) * self.reciprocal) >> 43;
        let rest = (weight * self.draws).wrapping_sub(estimate * self.total);
        let short = rest >= self.total;
        (estimate + u64::from(short), if short { rest - self.total } else { rest })
    }
}
