//! Reproducible randomness: a seed and an index determine a stream, independently of the thread.

use rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal, StandardUniform};
use rand_xoshiro::{SplitMix64, Xoshiro256PlusPlus};

/// The random generator for trial number `index` of the experiment with this `seed`.
pub fn stream(seed: u64, index: u64) -> Xoshiro256PlusPlus {
    // The seed is scrambled before the index is mixed in, so that neighbouring seeds do not share
    // streams.
    let key = SplitMix64::seed_from_u64(seed).next_u64();
    Xoshiro256PlusPlus::seed_from_u64(key ^ index)
}

/// A uniformly distributed number in 0 ≤ u < 1.
pub fn uniform<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    StandardUniform.sample(rng)
}

/// A normally distributed number with zero mean.
pub fn normal<R: Rng + ?Sized>(rng: &mut R, sigma: f64) -> f64 {
    let unit: f64 = StandardNormal.sample(rng);
    sigma * unit
}

/// Three independent normally distributed numbers with zero mean.
pub fn normal3<R: Rng + ?Sized>(rng: &mut R, sigma: f64) -> [f64; 3] {
    std::array::from_fn(|_| normal(rng, sigma))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_by_seed_and_index() {
        let first = |seed, index| stream(seed, index).next_u64();
        assert_eq!(first(1, 2), first(1, 2));
        assert_ne!(first(1, 2), first(1, 3));
        assert_ne!(first(1, 2), first(2, 2));
        assert_ne!(first(1, 2), first(2, 1));
    }

    #[test]
    fn normal_has_the_spread_asked_for() {
        let mut rng = stream(1, 0);
        let squares: f64 = (0..10_000).map(|_| normal(&mut rng, 3.0).powi(2)).sum();
        assert!((squares / 10_000.0 - 9.0).abs() < 0.5);
    }
}
