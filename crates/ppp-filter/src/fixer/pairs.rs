//! Narrow lanes: the remaining ambiguities between two satellites of a system whose wide lanes are integers.

use heapless::Vec;
use kestirim_gnss_ppp::Constellation;
use kestirim_integer_ambiguity::Decorrelated;
use kestirim_kalman::{Gaussian, SparseRow};
use kestirim_scalar::Components;

use super::wide_lane::Candidate;

/// The standard deviation of model errors in each satellite's ambiguity (orbit, clock, antennas, weather), m.
const MODEL: f64 = 0.006;
/// The number of pairs that must be found at once. With six to eight, the integers of one in a hundred hours were wrong
/// together.
const FEWEST: usize = 9;
/// The minimum success rate.
const LEAST_SUCCESS: f64 = 0.98;
/// The minimum ratio at a success rate below [`HIGH_SUCCESS`].
const LEAST_RATIO: f64 = 3.0;
/// The success rate at which a lower ratio is enough.
const HIGH_SUCCESS: f64 = 0.995;
/// The minimum ratio at a high success rate. With it throughout, the integers of one in three hundred hours were wrong.
const RATIO_AT_HIGH_SUCCESS: f64 = 2.5;
/// The largest mean square of the integers' misfit, in variances.
const LARGEST_MISFIT: f64 = 3.0;

/// A satellite minus the highest of its system.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) one: Candidate,
    pub(super) reference: Candidate,
}

impl Pair {
    /// Pairs each satellite with the highest of its system.
    pub(super) fn all<'a, const N: usize>(
        candidates: &(impl Iterator<Item = &'a Candidate> + Clone),
    ) -> Vec<Self, N> {
        let mut pairs = Vec::new();
        for system in [Constellation::Gps, Constellation::Galileo] {
            let of_system =
                || candidates.clone().filter(|it| it.carriers.constellation() == system);
            let highest = of_system().max_by(|a, b| a.elevation.total_cmp(&b.elevation));
            let Some(&reference) = highest else { continue };
            for &one in of_system().filter(|it| it.satellite != reference.satellite) {
                let _ = pairs.push(Self { one, reference });
            }
        }
        pairs
    }

    /// The observation row of the difference of both ambiguities.
    pub(super) const fn row(&self) -> SparseRow<f64, 2> {
        SparseRow::new([(self.one.state, 1.0), (self.reference.state, -1.0)])
    }

    /// The difference of both ambiguities for an integer on the first carrier, m.
    pub(super) fn length(&self, integer: f64) -> f64 {
        let [first, second] = self.one.carriers.frequency();
        let wide = self.one.wide - self.reference.wide;
        let cycles = integer + second / (first - second) * wide;
        self.one.carriers.narrow_lane() * cycles + self.one.bias - self.reference.bias
    }

    /// The difference of both ambiguities in the estimate, m.
    pub(super) fn found<const N: usize>(&self, estimate: &Gaussian<f64, N>) -> f64 {
        let of = |state: usize| estimate.mean.as_array().get(state).copied().unwrap_or(0.0);
        of(self.one.state) - of(self.reference.state)
    }

    /// The float number of cycles on the first carrier in the estimate.
    fn float<const N: usize>(&self, estimate: &Gaussian<f64, N>) -> f64 {
        (self.found(estimate) - self.length(0.0)) / self.one.carriers.narrow_lane()
    }

    /// The covariance of two pairs, cycles².
    fn covariance<const N: usize>(&self, other: &Self, estimate: &Gaussian<f64, N>) -> f64 {
        let of = |a: &Candidate, b: &Candidate| {
            let model = if a.state == b.state { MODEL * MODEL } else { 0.0 };
            estimate.covariance.get(a.state, b.state).unwrap_or(0.0) + model
        };
        let square = of(&self.one, &other.one)
            - of(&self.one, &other.reference)
            - of(&self.reference, &other.one)
            + of(&self.reference, &other.reference);
        square / (self.one.carriers.narrow_lane() * other.one.carriers.narrow_lane())
    }

    /// The variance of a pair's length, m², if both ambiguities are integers: that of model errors.
    pub(super) const fn model_variance() -> f64 {
        2.0 * MODEL * MODEL
    }
}

/// The test results of the integers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Validation {
    pub(super) ratio: f64,
    pub(super) success_rate: f64,
}

/// The integers of some pairs that pass the tests.
pub(super) struct Found<const N: usize> {
    pub(super) pairs: Vec<Pair, N>,
    pub(super) integers: Vec<i64, N>,
    pub(super) validation: Validation,
}

/// Searches for the integers of all pairs, then of fewer, leaving out the lowest satellite each time (partial fixing).
/// Agreement with integers that are already held takes the place of the last test.
pub(super) fn search<const N: usize>(
    estimate: &Gaussian<f64, N>,
    candidates: &[Candidate],
    are_held: bool,
) -> Option<Found<N>> {
    let mut left_out = f64::NEG_INFINITY;
    loop {
        let some = candidates.iter().filter(|it| it.elevation > left_out);
        let pairs: Vec<Pair, N> = Pair::all(&some);
        if pairs.len() < FEWEST {
            return None;
        }
        let mut floats: Vec<f64, N> = Vec::new();
        for pair in &pairs {
            floats.push(pair.float(estimate)).ok()?;
        }
        let covariance = |i: usize, j: usize| match (pairs.get(i), pairs.get(j)) {
            (Some(one), Some(other)) => one.covariance(other, estimate),
            _ => 0.0,
        };
        let decorrelated = Decorrelated::<N>::new(&floats, covariance).ok()?;
        let success_rate = decorrelated.success_rate();
        if success_rate >= LEAST_SUCCESS
            && let Ok(nearest) = decorrelated.nearest()
        {
            let [distance, _] = nearest.distances;
            let fits = distance <= LARGEST_MISFIT * pairs.len() as f64;
            let ratio = nearest.ratio();
            let is_high = success_rate >= HIGH_SUCCESS;
            let least = if is_high { RATIO_AT_HIGH_SUCCESS } else { LEAST_RATIO };
            if ratio >= least && (fits || are_held) {
                let validation = Validation { ratio, success_rate };
                return Some(Found { pairs, integers: nearest.integers, validation });
            }
        }
        left_out = some.map(|it| it.elevation).min_by(f64::total_cmp)?;
    }
}
