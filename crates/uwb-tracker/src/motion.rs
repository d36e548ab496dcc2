//! Prediction of the estimate between measurements.

use crate::Config;
use kestirim_kalman::{ConstantVelocity, Error, Gaussian};
use kestirim_scalar::{Components, Scalar};

/// Random walk of the common bias, m²/s.
const BIAS_DENSITY: f64 = 1e-5;

/// Speed (m/s) above which the acceleration density grows with the third power of the speed: turning on the same
/// radius r means an acceleration of v²/r for about r/v.
const USUAL_SPEED: f64 = 1.2;
/// Limit of the speed's ratio to `USUAL_SPEED` in that growth, as the range of fixed point is limited.
const MOST_SPEED: f64 = 8.0;

/// The acceleration density of a tag, m²/s³, at its velocity.
#[inline]
fn density<T: Scalar, const D: usize, const N: usize>(estimate: &Gaussian<T, N>, usual: T) -> T {
    let velocity = estimate.mean.as_array().get(D..2 * D).unwrap_or_default();
    let squared = velocity.iter().fold(T::ZERO, |sum, &axis| sum + axis * axis);
    if squared <= T::from_f64(USUAL_SPEED * USUAL_SPEED) {
        return usual;
    }
    usual * faster(squared)
}

/// The third power of the ratio of a speed to the usual one, from the squared speed.
#[inline(never)] // Only for fast tags.
fn faster<T: Scalar>(squared: T) -> T {
    let ratio = squared.sqrt() * T::from_f64(1.0 / USUAL_SPEED);
    let ratio = ratio.min(T::from_f64(MOST_SPEED));
    ratio * ratio * ratio
}

/// Predicts the estimate over `interval` (s).
#[inline]
pub(crate) fn advance<T: Scalar, const D: usize, const N: usize>(
    estimate: &mut Gaussian<T, N>,
    config: &Config<T>,
    interval: T,
    still: bool,
    push: Option<[T; D]>,
) -> Result<(), Error> {
    let density =
        if still { T::ZERO } else { density::<T, D, N>(estimate, config.acceleration_density) };
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

    /// The estimate after ten seconds, of a tag that moved at 1 m/s along every axis.
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
    fn a_fast_tag_turns_on_the_same_radius() {
        let density = |speed: f64| {
            let mean = SVector::from([0.0, 0.0, 0.6 * speed, -0.8 * speed, 0.0]);
            let estimate = Gaussian::new(mean, Covariance::zero());
            super::density::<f64, 2, 5>(&estimate, 0.1)
        };
        for (speed, times) in [(0.0, 1.0), (1.19, 1.0), (2.4, 8.0), (9.5, 496.0), (99.0, 512.0)] {
            let found = density(speed) / 0.1;
            assert!((found / times - 1.0).abs() < 1e-3, "{speed} m/s: {found}");
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
