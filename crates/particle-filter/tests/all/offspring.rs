//! Properties of the resampling schemes: unbiased, within their bounds, and total for any weights.

use kestirim_particle_filter::{
    Error, IntegerWeights, Multinomial, Resample, Resampler, Residual, Stratified, Systematic,
    Xoshiro128PlusPlus, offspring,
};
use kestirim_scalar::{Q12_20, Q16_16, Scalar};
use proptest::prelude::*;
use rand_core::{Rng, SeedableRng};

const LAWS: [Resampler; 4] =
    [Resampler::Multinomial, Resampler::Residual, Resampler::Stratified, Resampler::Systematic];
const N: usize = 100;
const REPETITIONS: usize = 1000;

/// Weights that span three orders of magnitude.
fn uneven() -> [f64; N] {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(3);
    [(); N].map(|()| (f64::from(rng.next_u32()) / 4_294_967_296.0).powi(3) + 1e-3)
}

/// Mean and variance of the number of offspring of each weight, and the expected number.
fn statistics<T: Scalar>(law: Resampler) -> Result<Vec<[f64; 3]>, Error> {
    let weights = uneven().map(T::from_f64);
    let total: f64 = weights.iter().map(|weight| weight.to_f64()).sum();
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(4);
    let mut sums = [[0.0; 2]; N];
    let mut counts = [0; N];
    for _ in 0..REPETITIONS {
        offspring(law, &weights, &mut counts, &mut rng)?;
        assert_eq!(counts.iter().sum::<u32>(), N as u32);
        for (sums, &count) in sums.iter_mut().zip(&counts) {
            sums[0] += f64::from(count);
            sums[1] += f64::from(count).powi(2);
        }
    }
    let repetitions = REPETITIONS as f64;
    let each = sums.iter().zip(&weights).map(|([sum, square], weight)| {
        let mean = sum / repetitions;
        [mean, square / repetitions - mean * mean, N as f64 * weight.to_f64() / total]
    });
    Ok(each.collect())
}

fn check_unbiased<T: Scalar>() -> Result<(), Error> {
    let mut variances = Vec::new();
    for law in LAWS {
        let statistics = statistics::<T>(law)?;
        // 10⁵ draws: χ² with 99 degrees of freedom is below 161 in 9999 cases of 10 000, and even smaller
        // for schemes of smaller variance.
        let chi2: f64 = statistics
            .iter()
            .map(|[mean, _, expected]| REPETITIONS as f64 * (mean - expected).powi(2) / expected)
            .sum();
        assert!(chi2 < 161.0, "{law:?}: {chi2}");
        for [mean, variance, expected] in &statistics {
            // For a few draws the sample variance means little, and for none nothing: Poisson's is used then.
            let error = (variance.max(expected.min(0.01)) / REPETITIONS as f64).sqrt();
            assert!((mean - expected).abs() < 4.5 * error, "{law:?}: {mean} for {expected}");
        }
        variances.push(statistics.iter().map(|[_, variance, _]| variance).sum::<f64>());
    }
    // The variance of a multinomial count is N·w·(1 − w).
    let total: f64 = uneven().iter().sum();
    let theory: f64 = uneven().iter().map(|w| N as f64 * w / total * (1.0 - w / total)).sum();
    assert!((variances[0] / theory - 1.0).abs() < 0.05, "{} {theory}", variances[0]);
    for (law, variance) in LAWS.iter().zip(&variances).skip(1) {
        assert!(*variance < 0.8 * variances[0], "{law:?}: {variance}");
    }
    Ok(())
}

#[test]
fn all_laws_are_unbiased_and_none_varies_more_than_the_multinomial() -> Result<(), Error> {
    check_unbiased::<f64>()?;
    check_unbiased::<f32>()?;
    check_unbiased::<Q16_16>()?;
    check_unbiased::<Q12_20>()
}

fn drawn(law: impl Resample) -> Result<[u32; N], Error> {
    let mut counts = [0; N];
    offspring(law, &uneven(), &mut counts, &mut Xoshiro128PlusPlus::seed_from_u64(6))?;
    Ok(counts)
}

/// A user-defined scheme: all offspring are those of the first particle.
struct First;

impl Resample for First {
    fn replace<R: Rng + ?Sized>(self, weights: IntegerWeights<'_>, _: &mut R) {
        let (counts, _, draws) = weights.into_parts();
        counts.fill(0);
        counts[0] = draws;
    }
}

#[test]
fn laws_are_types_too_and_a_users_own_is_asked() -> Result<(), Error> {
    assert_eq!(drawn(Multinomial)?, drawn(Resampler::Multinomial)?);
    assert_eq!(drawn(Residual)?, drawn(Resampler::Residual)?);
    assert_eq!(drawn(Stratified)?, drawn(Resampler::Stratified)?);
    assert_eq!(drawn(Systematic)?, drawn(Resampler::Systematic)?);
    let own = drawn(First)?;
    assert_eq!((own[0], own[1..].iter().sum::<u32>()), (N as u32, 0));
    Ok(())
}

#[test]
fn independent_draws_are_independent() -> Result<(), Error> {
    // The joint distribution: the counts in the first half of equal weights are binomial with variance n/4,
    // and neighbours are anticorrelated only by 1/n.
    let weights = [1.0_f32; 300];
    let mut counts = [0; 300];
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(5);
    let (mut half, mut pairs) = (0.0, 0.0);
    for _ in 0..4000 {
        offspring(Resampler::Multinomial, &weights, &mut counts, &mut rng)?;
        half += (f64::from(counts[..150].iter().sum::<u32>()) - 150.0).powi(2);
        pairs += counts
            .windows(2)
            .map(|c| (f64::from(c[0]) - 1.0) * (f64::from(c[1]) - 1.0))
            .sum::<f64>();
    }
    assert!((half / 4000.0 / 75.0 - 1.0).abs() < 0.1, "{}", half / 4000.0);
    assert!((pairs / 4000.0 / 299.0 + 1.0 / 300.0).abs() < 0.006, "{}", pairs / 4000.0 / 299.0);
    Ok(())
}

fn check_bounds<T: Scalar>(weights: &[T], seed: u64) -> Result<(), TestCaseError> {
    let largest = weights.iter().fold(0.0_f64, |largest, weight| largest.max(weight.to_f64()));
    let total: f64 = weights.iter().map(|weight| weight.to_f64() / largest).sum();
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(seed);
    let mut counts = vec![0; weights.len()];
    for law in LAWS {
        prop_assert_eq!(offspring(law, weights, &mut counts, &mut rng), Ok(()));
        prop_assert_eq!(counts.iter().sum::<u32>() as usize, weights.len());
        for (&count, weight) in counts.iter().zip(weights) {
            let expected = weights.len() as f64 * (weight.to_f64() / largest) / total;
            let count = f64::from(count);
            // Weights are rounded to 2⁻³¹ of the largest, in single precision to their own last bit.
            let rounding = 1e-4;
            match law {
                Resampler::Systematic => prop_assert!((count - expected).abs() < 1.0 + rounding),
                Resampler::Stratified => prop_assert!((count - expected).abs() < 2.0 + rounding),
                Resampler::Residual => prop_assert!(
                    count > expected.floor() - 1.0 + 1e-9 || count >= (expected - rounding).floor()
                ),
                Resampler::Multinomial => {}
            }
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn counts_keep_their_bounds(
        weights in proptest::collection::vec(prop_oneof![Just(0.0), 1e-30..1.0_f64, 0.1..1.0_f64], 1..400),
        seed in any::<u64>(),
    ) {
        prop_assume!(weights.iter().any(|&weight| weight > 1e-6));
        check_bounds(&weights, seed)?;
        check_bounds(&weights.iter().map(|&weight| weight as f32).collect::<Vec<_>>(), seed)?;
        let fixed: Vec<_> = weights.iter().map(|&weight| Q16_16::from_f64(weight)).collect();
        if fixed.iter().any(|&weight| weight > Q16_16::ZERO) {
            check_bounds(&fixed, seed)?;
        }
    }
}

#[test]
fn pathological_weights() -> Result<(), Error> {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(6);
    for law in LAWS {
        let mut counts = [7; 5];
        offspring(law, &[0.0, 0.0, 1.0_f32, 0.0, 0.0], &mut counts, &mut rng)?;
        assert_eq!(counts, [0, 0, 5, 0, 0]);
        for tiny in [1e-38_f32, 1e-45, f32::MIN_POSITIVE, f32::MAX] {
            offspring(law, &[0.0, tiny, 0.0, 0.0, 0.0], &mut counts, &mut rng)?;
            assert_eq!(counts, [0, 5, 0, 0, 0], "{law:?} {tiny}");
        }
        // The last weight, where a cumulative sum of floats would end before one.
        offspring(law, &[0.0, 0.0, 0.0, 0.0, 1e-38_f32], &mut counts, &mut rng)?;
        assert_eq!(counts, [0, 0, 0, 0, 5]);
        let mut one = [0];
        offspring(law, &[0.3_f64], &mut one, &mut rng)?;
        assert_eq!(one, [1]);
        let before = [9; 5];
        let mut counts = before;
        let mut refuse = |weights: &[f64], error| {
            assert_eq!(offspring(law, weights, &mut counts, &mut rng), Err(error));
            assert_eq!(counts, before);
        };
        refuse(&[0.0; 5], Error::Degenerate);
        refuse(&[1.0, f64::NAN, 1.0, 1.0, 1.0], Error::NotFinite);
        refuse(&[1.0, f64::INFINITY, 1.0, 1.0, 1.0], Error::NotFinite);
        refuse(&[1.0, -1e-3, 1.0, 1.0, 1.0], Error::NotPositive);
        refuse(&[1.0; 4], Error::TooMany);
        let mut none: [u32; 0] = [];
        assert_eq!(offspring::<f32, _>(law, &[], &mut none, &mut rng), Err(Error::Degenerate));
    }
    Ok(())
}

#[test]
fn a_hundred_thousand_weights() -> Result<(), Error> {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(7);
    let weights: Vec<f32> = (0..100_000).map(|_| f64::from(rng.next_u32()) as f32).collect();
    let total: f64 = weights.iter().map(|&weight| f64::from(weight)).sum();
    let mut counts = vec![0; weights.len()];
    for law in LAWS {
        offspring(law, &weights, &mut counts, &mut rng)?;
        assert_eq!(counts.iter().sum::<u32>(), 100_000);
        let half: u32 = counts[..50_000].iter().sum();
        let expected: f64 = weights[..50_000].iter().map(|&weight| f64::from(weight)).sum::<f64>();
        let off = (f64::from(half) - 1e5 * expected / total).abs();
        assert!(off < if law == Resampler::Multinomial { 800.0 } else { 500.0 }, "{law:?} {off}");
    }
    Ok(())
}

/// A random number generator that always returns the same number.
struct Stuck(u32);

impl rand_core::TryRng for Stuck {
    type Error = core::convert::Infallible;
    fn try_next_u32(&mut self) -> Result<u32, Self::Error> {
        Ok(self.0)
    }
    fn try_next_u64(&mut self) -> Result<u64, Self::Error> {
        Ok(u64::from(self.0) << 32 | u64::from(self.0))
    }
    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error> {
        bytes.fill(self.0 as u8);
        Ok(())
    }
}

#[test]
fn a_broken_generator_breaks_nothing_else() -> Result<(), Error> {
    for number in [0, 1, 1 << 31, u32::MAX] {
        for law in LAWS {
            let mut counts = [0; 200];
            offspring(law, &[1.0_f32; 200], &mut counts, &mut Stuck(number))?;
            assert_eq!(counts.iter().sum::<u32>(), 200, "{law:?} {number}");
        }
    }
    Ok(())
}
