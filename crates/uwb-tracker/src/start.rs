//! A first position, or a new one.

use crate::Config;
use crate::health::MOST_TRIES;
use crate::link::Link;
use heapless::Vec;
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_scalar::{Columns, Components, Scalar};
use kestirim_uwb_ranging::{Fix, Observation, Solver, expected_range};
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

/// The estimate that the fresh ranges make, if they are enough and agree with each other, or after many `tries` even if they
/// do not.
pub(crate) fn start<T: Scalar, const D: usize, const N: usize, const A: usize>(
    config: &Config<T>,
    links: &[Link<T>],
    time_us: u64,
    fresh_us: u64,
    tries: u8,
) -> Option<Gaussian<T, N>> {
    let variance = config.range_sigma * config.range_sigma;
    let mut observations = Vec::<Observation<T>, A>::new();
    for link in links {
        if let Some((range, age_us)) = link.fresh(time_us, fresh_us) {
            let anchor = link.anchor.position;
            // The tag may have moved since.
            let age = T::from_micro(age_us.min(fresh_us) as i32);
            let moved = (age * T::from_f64(VELOCITY_SIGMA)).min(T::from_f64(FARTHEST));
            let variance = variance + moved * moved;
            observations.push(Observation { anchor, range, variance }).ok()?;
        }
    }
    let estimates_bias = N > 2 * D;
    let solver = Solver {
        height: config.height,
        room: config.room,
        common_bias: estimates_bias.then_some(config.common_bias_sigma),
        huber: config.huber,
    };
    let most = T::from_f64(LARGEST_COST);
    // In turn: all ranges, and all but one. Both at once take longer than a sample may.
    let fix = if tries % 2 == 1 && tries < MOST_TRIES {
        without_one(&solver, &observations, most, tries / 2)?
    } else {
        let fix = solver.solve::<D>(&observations, None).ok();
        fix.filter(|fix| fix.cost <= most || tries >= MOST_TRIES)?
    };
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
    if estimates_bias {
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

/// The position that the ranges make without one that is too long; none if they do not agree then either. What is left must
/// have a range to spare, without which the solver finds none. Each turn leaves out another one.
fn without_one<T: Scalar, const D: usize, const A: usize>(
    solver: &Solver<T>,
    observations: &Vec<Observation<T>, A>,
    most: T,
    turn: u8,
) -> Option<Fix<T, D>> {
    let index = usize::from(turn).checked_rem(observations.len())?;
    let blocked = observations.get(index)?;
    let mut rest = Vec::<Observation<T>, A>::new();
    for (other, observation) in observations.iter().enumerate() {
        if other != index {
            rest.push(*observation).ok()?;
        }
    }
    let fix = solver.solve::<D>(&rest, None).ok()?;
    let expected = expected_range(&fix.position, solver.height, &blocked.anchor).distance;
    let excess = blocked.range - expected - fix.common_bias;
    let is_blocked = excess * excess > blocked.variance * most && excess > T::ZERO;
    (is_blocked && fix.cost <= most).then_some(fix)
}

#[cfg(test)]
mod tests;
