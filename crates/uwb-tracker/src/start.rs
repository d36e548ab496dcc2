//! A first position, or a new one.

use crate::Config;
use crate::link::Link;
use heapless::Vec;
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_scalar::{Columns, Components, Scalar};
use kestirim_uwb_ranging::{Observation, Solver};
use nalgebra::{SMatrix, SVector};

/// Standard deviation that biases add to the fit's, m.
const POSITION_SIGMA: f64 = 0.1;
/// Standard deviation of the velocity of a tag when it is first heard, m/s.
const VELOCITY_SIGMA: f64 = 0.5;

/// Largest cost of a fit; one that costs more has an outlier among its ranges: three standard
/// deviations a range cost 3.
const LARGEST_COST: f64 = 12.0;

/// The estimate that the fresh ranges make, if they are enough and, unless there is no more `patience`, agree
/// with each other.
pub(crate) fn start<T: Scalar, const D: usize, const N: usize, const A: usize>(
    config: &Config<T>,
    links: &[Link<T>],
    time_us: u64,
    fresh_us: u64,
    patience: bool,
) -> Option<Gaussian<T, N>> {
    let variance = config.range_sigma * config.range_sigma;
    let mut observations = Vec::<Observation<T>, A>::new();
    for link in links {
        if let Some((range, age_us)) = link.fresh(time_us, fresh_us) {
            let anchor = link.anchor.position;
            // The tag may have moved since.
            let moved = T::from_micro(age_us.min(fresh_us) as i32) * T::from_f64(VELOCITY_SIGMA);
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
    let fix = solver.solve::<D>(&observations, None).ok()?;
    if patience && fix.cost > T::from_f64(LARGEST_COST) {
        return None;
    }
    let mut mean = SVector::<T, N>::zeros();
    let mut covariance = SMatrix::<T, N, N>::zeros();
    for axis in 0..D {
        mean.as_array_mut()[axis] = fix.position.as_array()[axis];
        for other in axis..D {
            covariance.as_columns_mut()[axis][other] = fix.covariance.as_columns()[axis][other];
        }
        covariance.as_columns_mut()[axis][axis] += T::from_f64(POSITION_SIGMA * POSITION_SIGMA);
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
