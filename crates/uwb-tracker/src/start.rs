//! A first position, or a new one: looked for in a few steps with each range, so that no range takes much longer than another.

use crate::Config;
use crate::link::Link;
use heapless::Vec;
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_scalar::{Columns, Components, Scalar};
use kestirim_uwb_ranging::{Fix, Observation, Search, Solver, expected_range};
use nalgebra::{SMatrix, SVector};

/// Standard deviation that biases add to the fit's, m.
const POSITION_SIGMA: f64 = 0.1;
/// Standard deviation of the velocity of a tag when it is first heard, m/s.
const VELOCITY_SIGMA: f64 = 0.5;

/// Farther than this a tag is not taken to have moved, m: fixed point needs variances that are not too different.
const FARTHEST: f64 = 1.0;
/// Share by which the fit's variances grow: of poor geometries fixed point does not find them better.
const ROUNDING: f64 = 1.0 / 64.0;

/// Largest cost of a fit; one that costs more has an outlier among its ranges: three standard
/// deviations a range cost 3.
const LARGEST_COST: f64 = 12.0;

/// After so many ranges without a position, ranges that contradict each other are accepted, too.
const MOST_TRIES: u8 = 20;

/// Residuals that a range has time for beside its own: of four anchors in five steps, of eight in two.
const WORK: usize = 20;
/// Age of the ranges beyond which the tag may be anywhere (µs).
const LONGEST_US: u64 = 3_000_000;

/// The search for a position of D coordinates among up to A anchors.
///
/// An attempt is made with the ranges that are fresh at one moment; what is heard while it goes on is for the next.
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
    /// The moment (µs).
    time_us: u64,
    /// The ranges that were fresh then, in the order of the links; none at all between two attempts.
    ranges: Vec<Option<Fresh<T>>, A>,
    search: Search<T, D>,
    /// The link that is left out, when all have contradicted each other.
    without: Option<usize>,
    /// Ranges since the first attempt began.
    tries: u8,
}

/// A range (m) and its variance (m²).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Fresh<T> {
    range: T,
    variance: T,
}

/// A position that was found, and when the tag was there (µs).
pub(crate) struct Begun<T: Scalar, const N: usize> {
    pub(crate) estimate: Gaussian<T, N>,
    pub(crate) time_us: u64,
}

/// What an attempt has come to.
enum Progress<T: Scalar, const D: usize> {
    /// There are more steps to take.
    Unfinished,
    /// The ranges make this position.
    Found(Fix<T, D>),
    /// They make none.
    Nothing,
}

impl<T: Scalar, const D: usize, const A: usize> Start<T, D, A> {
    /// Before the first range.
    pub(crate) fn new() -> Self {
        let search = Search::new(None);
        Self { time_us: 0, ranges: Vec::new(), search, without: None, tries: 0 }
    }

    /// Whether an attempt goes on.
    pub(crate) fn is_on(&self) -> bool {
        !self.ranges.is_empty()
    }

    /// Takes some steps, now that another range was heard; an attempt begins where that `may` be. The estimate that its ranges
    /// make, if they agree with each other, or all but one that is too long, or after many ranges even if they do not.
    pub(crate) fn go_on<const N: usize>(
        &mut self,
        config: &Config<T>,
        links: &[Link<T>],
        (time_us, fresh_us): (u64, u64),
        may: bool,
    ) -> Option<Begun<T, N>> {
        let oldest_us = time_us.saturating_sub(fresh_us.min(LONGEST_US));
        if self.time_us < oldest_us {
            self.ranges.clear();
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
        let fix = match self.advance(&solver, links, accepts_all) {
            Progress::Unfinished => return None,
            Progress::Found(fix) => fix,
            Progress::Nothing => {
                self.ranges.clear();
                return None;
            }
        };
        self.ranges.clear();
        self.tries = 0;
        Some(Begun { estimate: estimate(config, &fix)?, time_us: self.time_us })
    }

    /// Begins an attempt with the ranges that are fresh now.
    fn begin(&mut self, config: &Config<T>, links: &[Link<T>], (time_us, fresh_us): (u64, u64)) {
        let variance = config.range_sigma * config.range_sigma;
        for link in links {
            let fresh = link.fresh(time_us, fresh_us).map(|(range, age_us)| {
                // The tag may have moved since.
                let age = T::from_micro(age_us.min(fresh_us) as i32);
                let moved = (age * T::from_f64(VELOCITY_SIGMA)).min(T::from_f64(FARTHEST));
                Fresh { range, variance: variance + moved * moved }
            });
            // There are no more links than places.
            let _ = self.ranges.push(fresh);
        }
        (self.time_us, self.without, self.search) = (time_us, None, Search::new(None));
    }

    /// The ranges but for the one that is left out.
    fn observations(&self, links: &[Link<T>]) -> Vec<Observation<T>, A> {
        let mut observations = Vec::new();
        for (index, (link, fresh)) in links.iter().zip(&self.ranges).enumerate() {
            if let Some(Fresh { range, variance }) = *fresh
                && self.without != Some(index)
            {
                let anchor = link.anchor.position;
                let _ = observations.push(Observation { anchor, range, variance });
            }
        }
        observations
    }

    /// Takes as many steps as a range has time for. Where all ranges contradict each other, the attempt goes on without the
    /// longest, unless they are accepted all the same.
    fn advance(
        &mut self,
        solver: &Solver<T>,
        links: &[Link<T>],
        accepts_all: bool,
    ) -> Progress<T, D> {
        let observations = self.observations(links);
        let steps = WORK.checked_div(observations.len()).unwrap_or(1).max(1);
        let fix = match self.search.advance(solver, &observations, steps) {
            Ok(None) => return Progress::Unfinished,
            Ok(Some(fix)) => *fix,
            Err(_) => return Progress::Nothing,
        };
        let agrees = fix.cost <= T::from_f64(LARGEST_COST);
        match self.without {
            None if agrees || accepts_all => Progress::Found(fix),
            // What is left must have a range to spare, without which there is nothing to tell.
            None if observations.len() > D + 1 => {
                self.without = self.longest(solver, links, &fix);
                self.search = Search::near(fix.position);
                Progress::Unfinished
            }
            Some(index) if agrees && self.is_blocked(index, solver, links, &fix) => {
                Progress::Found(fix)
            }
            _ => Progress::Nothing,
        }
    }

    /// The link whose range is too long by most at a place.
    fn longest(&self, solver: &Solver<T>, links: &[Link<T>], fix: &Fix<T, D>) -> Option<usize> {
        let mut longest = T::MIN;
        let mut found = None;
        for index in 0..links.len() {
            let excess = self.excess(index, solver, links, fix);
            if let Some(excess) = excess.filter(|&it| it > longest) {
                (longest, found) = (excess, Some(index));
            }
        }
        found
    }

    /// By how much a range is too long at a place, m.
    #[inline(never)]
    fn excess(
        &self,
        index: usize,
        solver: &Solver<T>,
        links: &[Link<T>],
        fix: &Fix<T, D>,
    ) -> Option<T> {
        let (link, fresh) = (links.get(index)?, (*self.ranges.get(index)?)?);
        let expected = expected_range(&fix.position, solver.height, &link.anchor.position);
        Some(fresh.range - expected.distance - fix.common_bias)
    }

    /// Whether a range is far too long at a place.
    fn is_blocked(
        &self,
        index: usize,
        solver: &Solver<T>,
        links: &[Link<T>],
        fix: &Fix<T, D>,
    ) -> bool {
        let Some(Some(fresh)) = self.ranges.get(index) else { return false };
        let most = fresh.variance * T::from_f64(LARGEST_COST);
        let excess = self.excess(index, solver, links, fix);
        excess.is_some_and(|excess| excess > T::ZERO && excess * excess > most)
    }
}

/// The estimate that begins with a fix.
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
