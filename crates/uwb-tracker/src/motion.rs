//! What moves the estimate on, and what standing still says.

use crate::Config;
use kestirim_kalman::{ConstantVelocity, Error, Gaussian};
use kestirim_scalar::Scalar;

/// A standing tag moves by no more than this, m/s.
const STILL_SIGMA: f64 = 0.015;
/// The wheels slip, and the tag is not between them, m/s.
const SPEED_SIGMA: f64 = 0.1;
/// A velocity that contradicts by 3 σ that the tag stands, or drives as fast as its wheels turn.
const CONTRADICTION: f64 = 9.0;
/// What the common bias may change by, m²/s.
const BIAS_DENSITY: f64 = 1e-5;

/// Moves the estimate on by `interval` (s).
#[inline]
pub(crate) fn advance<T: Scalar, const D: usize, const N: usize>(
    estimate: &mut Gaussian<T, N>,
    config: &Config<T>,
    interval: T,
    still: bool,
    push: Option<[T; D]>,
) -> Result<(), Error> {
    let density = if still { T::ZERO } else { config.acceleration_density };
    let motion = ConstantVelocity::<T, D>::new(interval, density);
    estimate.advance(&ConstantVelocity {
        decay_time: config.decay_time,
        acceleration: push,
        ..motion
    })?;
    if N > 2 * D {
        estimate.add_variance_at(2 * D, interval * T::from_f64(BIAS_DENSITY))?;
    }
    Ok(())
}

/// Whether the velocity may be zero: no component is clearly beyond what is not known of it.
#[inline]
pub(crate) fn may_stand<T: Scalar, const D: usize, const N: usize>(
    estimate: &Gaussian<T, N>,
) -> bool {
    let variances = estimate.covariance.variances();
    let pairs = estimate.mean.iter().zip(variances.iter()).skip(D).take(D);
    let mut standing = pairs.map(|(&velocity, &variance)| {
        let spread = variance + T::from_f64(STILL_SIGMA * STILL_SIGMA);
        velocity * velocity <= spread * T::from_f64(CONTRADICTION)
    });
    standing.all(|standing| standing)
}

/// Takes in that the velocity is zero.
#[inline]
pub(crate) fn stand_still<T: Scalar, const D: usize, const N: usize>(
    estimate: &mut Gaussian<T, N>,
) -> Result<(), Error> {
    let variance = T::from_f64(STILL_SIGMA * STILL_SIGMA);
    for index in D..2 * D {
        let velocity = estimate.mean.data.0[0].get(index).copied().unwrap_or(T::ZERO);
        let weighed = estimate.weigh_entries(&[(index, T::ONE)], -velocity, variance)?;
        estimate.correct(&weighed)?;
    }
    Ok(())
}

/// Takes in how fast the wheels turn: a measurement of the velocity along itself.
#[inline]
pub(crate) fn drive<T: Scalar, const D: usize, const N: usize>(
    estimate: &mut Gaussian<T, N>,
    speed: T,
) -> Result<(), Error> {
    let velocity: [T; D] = core::array::from_fn(|axis| {
        estimate.mean.data.0[0].get(D + axis).copied().unwrap_or(T::ZERO)
    });
    let size = T::norm(&velocity);
    // Which way it drives must be known before how fast helps.
    if size < speed.abs() * T::HALF || size <= T::from_f64(0.02) {
        return Ok(());
    }
    let divisor = size.divisor();
    let mut row = [(0, T::ZERO); 3];
    for (axis, (entry, component)) in row.iter_mut().zip(velocity).enumerate() {
        *entry = (D + axis, component.divided_by(divisor));
    }
    let row = row.get(..D).unwrap_or(&row);
    let variance = T::from_f64(SPEED_SIGMA * SPEED_SIGMA);
    let weighed = estimate.weigh_entries(row, speed.abs() - size, variance)?;
    if !weighed.exceeds(T::from_f64(CONTRADICTION)) {
        estimate.correct(&weighed)?;
    }
    Ok(())
}
