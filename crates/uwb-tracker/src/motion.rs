//! Prediction of the estimate between measurements.

use crate::Config;
use kestirim_kalman::{ConstantVelocity, Error, Gaussian};
use kestirim_scalar::Scalar;

/// Random walk of the common bias, m²/s.
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
