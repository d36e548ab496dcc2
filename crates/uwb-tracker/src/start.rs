//! The search for a first or new position, a few steps with each range, so that no range takes much longer than
//! another.

use crate::Config;
use crate::link::Link;
use heapless::Vec;
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_scalar::{Columns, Components, Scalar};
use kestirim_uwb_ranging::{Fix, Observation, Search, Solver, expected_range};
use nalgebra::{SMatrix, SVector};

/// Standard deviation that biases add to the fix's, m.
const POSITION_SIGMA: f64 = 0.1;
/// Initial standard deviation of each component of a tag's velocity, m/s.
const VELOCITY_SIGMA: f64 = 0.5;

/// Largest distance that a tag is assumed to have moved, m: fixed point needs variances that do not differ too much.
const FARTHEST: f64 = 1.0;
/// Share by which the variances of the fix are increased: with poor geometries fixed point is no more accurate.
const ROUNDING: f64 = 1.0 / 64.0;

/// Largest cost of a fix; a larger one indicates an outlier among its ranges: three standard deviations per range cost
/// 3.
const LARGEST_COST: f64 = 12.0;

/// Number of ranges without a position after which contradictory ranges are accepted, too.
const MOST_TRIES: u8 = 20;

/// Number of residuals computed per range: five steps with four anchors, two with eight. Slow radios allow
/// [more](crate::pace::Pace::leisure).
const WORK: usize = 20;
/// Age of the ranges beyond which the tag may be anywhere, µs.
const LONGEST_US: u64 = 3_000_000;

/// The search for a position with D coordinates among up to A anchors.
///
/// An attempt uses the ranges that are fresh at one time; those that arrive during it are for the next.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Start<T: Scalar, const D: usize, const A: usize> {
    /// Time of the attempt, µs.
    time_us: u64,
    /// The ranges that were fresh then; empty between two attempts.
    observations: Vec<Observation<T>, A>,
    search: Search<T, D>,
    /// Whether the last of the observations is left out, because all together were contradictory.
    leaves_out: bool,
    /// Number of ranges since the first attempt began.
    tries: u8,
}

/// A position that was found, and the time (µs) to which it applies.
pub(crate) struct Begun<T: Scalar, const N: usize> {
    pub(crate) estimate: Gaussian<T, N>,
    pub(crate) time_us: u64,
}

/// The progress of an attempt.
enum Progress<T: Scalar, const D: usize> {
    /// There are more steps to take.
    Unfinished,
    /// The ranges determine this position.
    Found(Fix<T, D>),
    /// The ranges determine no position.
    Nothing,
}

impl<T: Scalar, const D: usize, const A: usize> Start<T, D, A> {
    /// Creates the state before the first range.
    pub(crate) fn new() -> Self {
        let search = Search::new(None);
        Self { time_us: 0, observations: Vec::new(), search, leaves_out: false, tries: 0 }
    }

    /// Whether an attempt is in progress.
    pub(crate) fn is_on(&self) -> bool {
        !self.observations.is_empty()
    }

    /// Takes some steps after another range was heard, and starts an attempt if it `may`. Returns the estimate from
    /// the attempt's ranges if they are consistent, or all but one that is too long, or after many ranges even if they
    /// are not.
    pub(crate) fn go_on<const N: usize>(
        &mut self,
        config: &Config<T>,
        links: &[Link<T>],
        (time_us, fresh_us): (u64, u64),
        leisure: usize,
        may: bool,
    ) -> Option<Begun<T, N>> {
        let oldest_us = time_us.saturating_sub(fresh_us.min(LONGEST_US));
        if self.time_us < oldest_us {
            self.observations.clear();
        }
        if !self.is_on() {
            if !may {
                return None;
            }
            self.begin(config, links, (time_us, fresh_us));
        }
        let accepts_all = self.tries >= MOST_TRIES;
        self.tries = self.tries.saturating_add(1);
        let solver = Solver {
            height: config.height,
            room: config.room,
            common_bias: (N > 2 * D).then_some(config.common_bias_sigma),
            huber: config.huber,
        };
        let fix = match self.advance(&solver, WORK.saturating_mul(leisure), accepts_all) {
            Progress::Unfinished => return None,
            Progress::Found(fix) => fix,
            Progress::Nothing => {
                self.observations.clear();
                return None;
            }
        };
        self.observations.clear();
        self.tries = 0;
        Some(Begun { estimate: estimate(config, &fix)?, time_us: self.time_us })
    }

    /// Starts an attempt with the ranges that are fresh now.
    fn begin(&mut self, config: &Config<T>, links: &[Link<T>], (time_us, fresh_us): (u64, u64)) {
        let variance = config.range_sigma * config.range_sigma;
        for link in links {
            let Some((range, age_us)) = link.fresh(time_us, fresh_us) else { continue };
            // The tag may have moved since.
            let age = T::from_micro(age_us.min(fresh_us) as i32);
            let moved = (age * T::from_f64(VELOCITY_SIGMA)).min(T::from_f64(FARTHEST));
            let (anchor, variance) = (link.anchor.position, variance + moved * moved);
            // There are no more links than the capacity.
            let _ = self.observations.push(Observation { anchor, range, variance });
        }
        (self.time_us, self.leaves_out, self.search) = (time_us, false, Search::new(None));
    }

    /// Takes as many steps as there is time for with a range. If the ranges are contradictory, the attempt continues
    /// without the longest, unless they are accepted anyway.
    fn advance(&mut self, solver: &Solver<T>, work: usize, accepts_all: bool) -> Progress<T, D> {
        let count = self.observations.len().saturating_sub(usize::from(self.leaves_out));
        let observations = self.observations.get(..count).unwrap_or_default();
        let steps = work.checked_div(count).unwrap_or(1).max(1);
        let fix = match self.search.advance(solver, observations, steps) {
            Ok(None) => return Progress::Unfinished,
            Ok(Some(fix)) => *fix,
            Err(_) => return Progress::Nothing,
        };
        let agrees = fix.cost <= T::from_f64(LARGEST_COST);
        if self.leaves_out {
            let is_right = agrees && self.is_blocked(solver, &fix);
            return if is_right { Progress::Found(fix) } else { Progress::Nothing };
        }
        if agrees || accepts_all {
            return Progress::Found(fix);
        }
        // The remaining ranges must be redundant, otherwise they cannot be checked.
        if count <= D + 1 {
            return Progress::Nothing;
        }
        self.leave_out_longest(solver, &fix);
        Progress::Unfinished
    }

    /// Continues from a fix, without the range whose excess there is the largest.
    fn leave_out_longest(&mut self, solver: &Solver<T>, fix: &Fix<T, D>) {
        let (mut longest, mut found) = (T::MIN, 0);
        for (index, observation) in self.observations.iter().enumerate() {
            let excess = excess(solver, fix, observation);
            if excess > longest {
                (longest, found) = (excess, index);
            }
        }
        if let Some((last, others)) = self.observations.split_last_mut()
            && let Some(longest) = others.get_mut(found)
        {
            core::mem::swap(last, longest);
        }
        self.leaves_out = true;
        self.search = Search::near(fix.position);
    }

    /// Whether the range that is left out is far too long at the fix.
    fn is_blocked(&self, solver: &Solver<T>, fix: &Fix<T, D>) -> bool {
        self.observations.last().is_some_and(|observation| {
            let excess = excess(solver, fix, observation);
            let most = observation.variance * T::from_f64(LARGEST_COST);
            excess > T::ZERO && excess * excess > most
        })
    }
}

/// The excess of a range at a fix, m.
#[inline(never)]
fn excess<T: Scalar, const D: usize>(
    solver: &Solver<T>,
    fix: &Fix<T, D>,
    observation: &Observation<T>,
) -> T {
    let expected = expected_range(&fix.position, solver.height, &observation.anchor);
    observation.range - expected.distance - fix.common_bias
}

/// The initial estimate from a fix.
fn estimate<T: Scalar, const D: usize, const N: usize>(
    config: &Config<T>,
    fix: &Fix<T, D>,
) -> Option<Gaussian<T, N>> {
    let mut mean = SVector::<T, N>::zeros();
    let mut covariance = SMatrix::<T, N, N>::zeros();
    for axis in 0..D {
        mean.as_array_mut()[axis] = fix.position.as_array()[axis];
        for other in axis..D {
            covariance.as_columns_mut()[axis][other] = fix.covariance.as_columns()[axis][other];
        }
        let own = &mut covariance.as_columns_mut()[axis][axis];
        *own += *own * T::from_f64(ROUNDING) + T::from_f64(POSITION_SIGMA * POSITION_SIGMA);
        covariance.as_columns_mut()[D + axis][D + axis] =
            T::from_f64(VELOCITY_SIGMA * VELOCITY_SIGMA);
    }
    if N > 2 * D {
        mean.as_array_mut()[2 * D] = fix.common_bias;
        let known = fix.common_bias_variance > T::ZERO;
        covariance.as_columns_mut()[2 * D][2 * D] = if known {
            fix.common_bias_variance
        } else {
            config.common_bias_sigma * config.common_bias_sigma
        };
    }
    let covariance = Covariance::from_lower_triangle(&covariance);
    covariance.is_finite().then(|| Gaussian::new(mean, covariance))
}

#[cfg(test)]
mod tests;
