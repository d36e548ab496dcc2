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

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_kalman::Covariance;
    use nalgebra::SVector;

    /// Ten seconds of a tag that moved by 1 m/s in every direction.
    fn advanced<const D: usize, const N: usize>(still: bool) -> Gaussian<f64, N> {
        let mean = SVector::from_fn(|state, _| f64::from(u8::from((D..2 * D).contains(&state))));
        let mut estimate = Gaussian::new(mean, Covariance::zero());
        let config = Config::calibrated(1.0);
        advance::<f64, D, N>(&mut estimate, &config, 10.0, still, None).expect("a step");
        estimate
    }

    #[test]
    fn a_common_bias_wanders_by_a_centimetre_in_ten_seconds() {
        let plane = advanced::<2, 5>(false).covariance.variances()[4];
        let space = advanced::<3, 7>(false).covariance.variances()[6];
        for sigma in [plane.sqrt(), space.sqrt()] {
            assert!((sigma - 0.01).abs() < 1e-6, "{sigma} m");
        }
    }

    #[test]
    fn a_tag_that_stands_is_as_certain_as_before() {
        assert_eq!(advanced::<2, 4>(true).covariance, Covariance::zero());
        let moving = advanced::<2, 4>(false).covariance.variances();
        assert!(moving.iter().all(|&variance| variance > 0.0), "{moving}");
    }

    #[test]
    fn a_velocity_is_forgotten_within_seconds() {
        let velocity = advanced::<3, 6>(false).mean.fixed_rows::<3>(3).into_owned();
        assert!(velocity.iter().all(|&speed| (0.0..0.2).contains(&speed)), "{velocity}");
    }
}
