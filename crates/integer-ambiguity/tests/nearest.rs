//! The nearest integers, compared with all integers nearby.

use kestirim_integer_ambiguity::{Decorrelated, Error};
use proptest::prelude::*;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Number of random trials of the success rate.
const TRIALS: i32 = 20_000;

type Matrix = [[f64; 3]; 3];

/// The covariance Lᵀ D L for a unit lower triangular L.
fn covariance([l10, l20, l21]: [f64; 3], variances: [f64; 3]) -> Matrix {
    let lower = [[1.0, 0.0, 0.0], [l10, 1.0, 0.0], [l20, l21, 1.0]];
    let entry = |i: usize, j: usize| (0..3).map(|k| lower[k][i] * variances[k] * lower[k][j]).sum();
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}

/// The squared distance (a − z)ᵀ Q⁻¹ (a − z), evaluated from the last entry on, as Q = Lᵀ D L.
fn distance(factors: ([f64; 3], [f64; 3]), ambiguities: [f64; 3], integers: [i64; 3]) -> f64 {
    let ([l10, l20, l21], variances) = factors;
    let [x, y, z] = [0, 1, 2].map(|i| ambiguities[i] - integers[i] as f64);
    let last = z;
    let middle = y - l21 * last;
    let first = x - l10 * middle - l20 * last;
    first * first / variances[0] + middle * middle / variances[1] + last * last / variances[2]
}

/// The nearest of all integer vectors within `far` of the ambiguities, and the two smallest
/// distances.
fn by_trying(
    factors: ([f64; 3], [f64; 3]),
    ambiguities: [f64; 3],
    far: i64,
) -> ([i64; 3], [f64; 2]) {
    let [x, y, z] = ambiguities.map(|ambiguity| ambiguity.round() as i64);
    let mut best = ([0; 3], f64::INFINITY);
    let mut second = f64::INFINITY;
    for (i, j, k) in (-far..=far)
        .flat_map(|i| (-far..=far).flat_map(move |j| (-far..=far).map(move |k| (i, j, k))))
    {
        let integers = [x + i, y + j, z + k];
        let distance = distance(factors, ambiguities, integers);
        if distance < best.1 {
            second = best.1;
            best = (integers, distance);
        } else if distance < second {
            second = distance;
        }
    }
    (best.0, [best.1, second])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_integers_are_nearer(
        lower in prop::array::uniform3(-3.0..3.0_f64),
        variances in prop::array::uniform3(0.01..0.3_f64),
        ambiguities in prop::array::uniform3(-1e6..1e6_f64),
    ) {
        const FAR: i64 = 20;
        let q = covariance(lower, variances);
        let fix = Decorrelated::<4>::new(&ambiguities, |i, j| q[i][j])?.nearest()?;
        // Vectors farther away on an axis are then farther away than the second nearest.
        let widest = (0..3).map(|i| q[i][i]).fold(0.0, f64::max);
        prop_assume!((fix.distances[1] * widest).sqrt() < FAR as f64 - 1.0);
        let (integers, distances) = by_trying((lower, variances), ambiguities, FAR);
        prop_assert!((fix.distances[0] - distances[0]).abs() < 1e-6 * (1.0 + distances[0]));
        prop_assert!((fix.distances[1] - distances[1]).abs() < 1e-6 * (1.0 + distances[1]));
        if distances[1] - distances[0] > 1e-6 {
            prop_assert_eq!(&fix.integers[..], &integers[..]);
        }
    }

    #[test]
    fn whole_cycles_change_nothing_but_the_integers(
        lower in prop::array::uniform3(-3.0..3.0_f64),
        ambiguities in prop::array::uniform3(-0.4..0.4_f64),
        more in prop::array::uniform3(-1_000_000..1_000_000_i64),
    ) {
        let q = covariance(lower, [0.02, 0.05, 0.1]);
        let of = |ambiguities: [f64; 3]| {
            let decorrelated = Decorrelated::<3>::new(&ambiguities, |i, j| q[i][j])?;
            Ok::<_, Error>((decorrelated.nearest()?, decorrelated.success_rate()))
        };
        let (fix, rate) = of(ambiguities)?;
        let (farther, same) = of([0, 1, 2].map(|i| ambiguities[i] + more[i] as f64))?;
        prop_assert_eq!(rate, same);
        if fix.ratio() > 1.001 {
            let moved: Vec<_> = fix.integers.iter().zip(more).map(|(z, more)| z + more).collect();
            prop_assert_eq!(&farther.integers[..], &moved[..]);
        }
    }

    #[test]
    fn nothing_panics(
        ambiguities in prop::collection::vec(prop::num::f64::ANY, 0..8),
        entries in prop::array::uniform16(prop::num::f64::ANY),
    ) {
        let entry = |i: usize, j: usize| entries[(7 * i + j) % 16];
        if let Ok(decorrelated) = Decorrelated::<6>::new(&ambiguities, entry) {
            let _ = (decorrelated.nearest(), decorrelated.success_rate());
        }
    }
}

/// Right integers are found at least as often as the success rate says.
#[test]
fn the_success_rate_is_a_lower_bound() {
    let (lower, variances) = ([1.7, -0.6, 2.4], [0.09, 0.06, 0.04]);
    let q = covariance(lower, variances);
    let mut dice = Xoshiro256PlusPlus::seed_from_u64(0);
    // The sum of twelve uniform numbers is nearly normal.
    let mut uniform = || f64::from(dice.next_u32()) / 2_f64.powi(32);
    let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
    let (mut right, mut rate) = (0, 0.0);
    for _ in 0..TRIALS {
        let [e0, e1, e2] = [0, 1, 2].map(|i| variances[i].sqrt() * normal());
        let [l10, l20, l21] = lower;
        let errors = [e0 + l10 * e1 + l20 * e2, e1 + l21 * e2, e2];
        let decorrelated = Decorrelated::<3>::new(&errors, |i, j| q[i][j]).expect("a covariance");
        rate = decorrelated.success_rate();
        right += i32::from(decorrelated.nearest().expect("three").integers == [0, 0, 0]);
    }
    let share = f64::from(right) / f64::from(TRIALS);
    assert!((0.5..0.99).contains(&rate), "{rate}");
    assert!(share > rate - 0.02 && share < rate + 0.1, "{share} for {rate}");
}

#[test]
fn what_cannot_be_is_refused() {
    let new = |ambiguities: &[f64], variance: f64| {
        let entry = |i, j| if i == j { variance } else { 0.0 };
        Decorrelated::<2>::new(ambiguities, entry).map(|_| ())
    };
    assert_eq!(new(&[0.1, 0.2], 1.0), Ok(()));
    assert_eq!(new(&[], 1.0), Err(Error::WrongNumber));
    assert_eq!(new(&[0.1; 3], 1.0), Err(Error::WrongNumber));
    assert_eq!(new(&[f64::NAN], 1.0), Err(Error::NotFinite));
    assert_eq!(new(&[1e15], 1.0), Err(Error::NotFinite));
    assert_eq!(new(&[0.1], f64::INFINITY), Err(Error::NotFinite));
    assert_eq!(new(&[0.1], 0.0), Err(Error::NotPositive));
    assert_eq!(new(&[0.1], -1.0), Err(Error::NotPositive));
}

#[test]
fn a_search_without_an_end_is_given_up() {
    // Thirty ambiguities about which nothing is known.
    let ambiguities: Vec<f64> = (0..30).map(|i| 0.5 - 0.013 * f64::from(i)).collect();
    let entry = |i: usize, j: usize| if i == j { 1e4 } else { 0.0 };
    let decorrelated = Decorrelated::<30>::new(&ambiguities, entry).expect("a covariance");
    assert!(decorrelated.success_rate() < 1e-9);
    assert_eq!(decorrelated.nearest().map(|fix| fix.integers), Err(Error::Exhausted));
}

#[test]
fn one_ambiguity_is_rounded() {
    let fix = Decorrelated::<1>::new(&[-7.2], |_, _| 0.01).expect("one").nearest().expect("near");
    assert_eq!(fix.integers, [-7]);
    assert!((fix.distances[0] - 4.0).abs() < 1e-9 && (fix.distances[1] - 64.0).abs() < 1e-9);
    let exact = Decorrelated::<1>::new(&[3.0], |_, _| 0.01).expect("one").nearest().expect("near");
    assert_eq!((&exact.integers[..], exact.ratio()), (&[3][..], f64::INFINITY));
}
