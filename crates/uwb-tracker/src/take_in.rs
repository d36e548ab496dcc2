//! Weighting, gating, update and learning for a range, common to all trackers.

use crate::link::Link;
use crate::{Config, Error, Outcome};
use kestirim_kalman::{Gaussian, Innovation, Observation, Verdict, Weighed};
use kestirim_scalar::Scalar;

/// What is known about a range besides its value.
#[derive(Clone, Copy)]
pub(crate) struct Known {
    /// Whether there are more ranges than unknowns.
    pub(crate) is_redundant: bool,
    /// Whether the IMU or the wheels indicate that the tag stands.
    pub(crate) is_still: bool,
}

/// Updates the estimate with a range, or rejects it.
///
/// Ranges that are too long again and again mean a blocked anchor if the others are consistent, and otherwise a wrong
/// estimate. The anchor's noise is learnt where there are more ranges than unknowns (`is_redundant`): a range that the
/// estimate must follow fits whatever its quality. While IMU or wheels indicate that the tag stands (`is_still`), the
/// noise is not raised above its initial value: the residuals then mainly show whether it does stand.
///
/// # Errors
/// [`Error::Estimate`]; estimate and link are unchanged.
#[inline(always)]
pub(crate) fn take_in<T: Scalar, const N: usize>(
    estimate: &mut Gaussian<T, N>,
    link: &mut Link<T>,
    observation: &impl Observation<T, N>,
    config: &Config<T>,
    Known { is_redundant, is_still }: Known,
    others_agree: impl Fn() -> bool,
) -> Result<(Outcome, Innovation<T>), Error> {
    let weighed = estimate.weigh_observation(observation, link.noise.variance())?;
    let seen = weighed.report();
    let mut gate = link.gate;
    let verdict = if config.gate.is_some() { gate.judge(&weighed) } else { Verdict::Admit };
    let believed = gate.gamma() * weighed.variance();
    let (outcome, square) = match verdict {
        Verdict::Admit => {
            let square = weighed.innovation() * weighed.innovation();
            let outcome = if let Some(noise) = weakened(&weighed, config) {
                estimate.correct(&weighed.with_noise(noise)?)?;
                Outcome::Weakened
            } else {
                estimate.correct(&weighed)?;
                Outcome::Taken
            };
            link.is_blocked = false;
            (outcome, square)
        }
        Verdict::Reject => (Outcome::Rejected, believed),
        Verdict::Recover if weighed.innovation() > T::ZERO && others_agree() => {
            link.is_blocked = true;
            (Outcome::Rejected, believed)
        }
        Verdict::Recover => {
            // Fixed point limits the widening; then the estimate is given up sooner or later.
            let widened = estimate.correct_widened(&weighed, gate.gamma()).is_ok();
            (if widened { Outcome::Recovered } else { Outcome::Rejected }, believed)
        }
    };
    link.gate = gate;
    if is_redundant && let Some(learning) = &config.learning {
        let before = link.noise;
        link.noise.learn_square(learning, &weighed, square);
        if is_still && link.noise.variance() > config.range_sigma * config.range_sigma {
            link.noise = before;
        }
    }
    Ok((outcome, seen))
}

/// The noise that Huber's weight gives a range beyond the threshold: S grows to S |ν|/limit.
///
/// Ranges that are too long are doubted sooner than those that are too short, because of obstacles; but not for what
/// the tag itself may have done since it was last seen, which is as likely to lengthen as to shorten. So the limit is
/// k√R and at least one standard deviation of the expected range.
#[inline(always)]
fn weakened<T: Scalar, const N: usize>(weighed: &Weighed<T, N>, config: &Config<T>) -> Option<T> {
    let huber = config.huber.as_ref()?;
    let threshold = huber.threshold(weighed.innovation());
    let square = threshold * threshold;
    // The limit is at least this; most ranges are within it.
    if !weighed.exceeds(square) {
        return None;
    }
    let limit = square * weighed.noise() + square.max(T::ONE) * weighed.spread();
    if !weighed.exceeds(weighed.by_variance(limit)) {
        return None;
    }
    let variance = weighed.variance() * (weighed.innovation().abs() / limit.sqrt());
    Some((variance - weighed.spread()).max(weighed.noise()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Anchor;
    use kestirim_adaptive_kalman::MeasurementNoise;
    use kestirim_kalman::{Covariance, LinearObservation, SparseRow};
    use kestirim_uwb_ranging::Huber;
    use nalgebra::{SVector, vector};

    const MOVING: Known = Known { is_redundant: true, is_still: false };

    /// Variances of the prior position and of a range, m².
    const SPREAD: f64 = 0.03;
    const NOISE: f64 = 0.01;
    const DEVIATION: f64 = 0.2;

    fn estimate() -> Gaussian<f64, 2> {
        Gaussian::new(vector![5.0, 0.0], Covariance::from_variances(&[SPREAD, 1.0]))
    }

    fn link(config: &Config<f64>) -> Link<f64> {
        Link::new(Anchor { position: SVector::zeros(), bias: 0.0 }, config)
    }

    /// Processes a range along the first axis that is longer than expected by `excess`, with this `link` and whether
    /// others `agree`: the outcome, and the resulting change of the estimate (m).
    fn taken(
        link: &mut Link<f64>,
        config: &Config<f64>,
        excess: f64,
        agree: bool,
    ) -> (Outcome, f64) {
        let mut estimate = estimate();
        let observation =
            LinearObservation { row: SparseRow::new([(0, 1.0)]), measured: 5.0 + excess };
        let (outcome, seen) =
            take_in(&mut estimate, link, &observation, config, MOVING, || agree).expect("a range");
        assert!((seen.innovation - excess).abs() < 1e-9, "{seen:?}");
        assert!((seen.variance - SPREAD - NOISE).abs() < 1e-9, "{seen:?}");
        link.noise = self::link(config).noise;
        (outcome, estimate.mean[0] - 5.0)
    }

    /// A configuration with Huber's weights, without a gate.
    fn doubting() -> Config<f64> {
        let huber = Some(Huber { long: 0.5, short: 2.5 });
        Config { range_sigma: NOISE.sqrt(), huber, ..Config::plain(1.0) }
    }

    #[test]
    fn beyond_its_limit_a_range_moves_an_estimate_no_farther() {
        let config = doubting();
        // Too short: 2.5 standard deviations. Too long: half the radio's standard deviation, and one of the estimate.
        let long = (0.25 * NOISE + SPREAD).sqrt();
        for (limit, sign) in [(2.5 * DEVIATION, -1.0), (long, 1.0)] {
            let gain = SPREAD / (SPREAD + NOISE);
            for (excess, outcome) in [
                (0.5 * limit, Outcome::Taken),
                (0.999 * limit, Outcome::Taken),
                (1.001 * limit, Outcome::Weakened),
                (10.0 * limit, Outcome::Weakened),
            ] {
                let found = taken(&mut link(&config), &config, excess * sign, true);
                let moved = gain * excess.min(limit) * sign;
                assert_eq!(found.0, outcome, "{excess} {sign}");
                assert!((found.1 - moved).abs() < 1e-9, "{excess} {sign}: {found:?}, {moved}");
            }
        }
        let plain = Config { huber: None, ..config };
        assert_eq!(taken(&mut link(&plain), &plain, 10.0, true).0, Outcome::Taken);
    }

    #[test]
    fn a_range_of_no_more_doubt_than_its_noise_is_not_believed_more() {
        // The position has no variance, so that the limit is that of the radio alone.
        let config = doubting();
        let row = SparseRow::new([(0, 1.0)]);
        let known = Gaussian::new(vector![5.0, 0.0], Covariance::from_variances(&[0.0, 1.0]));
        let weighed = known.weigh(&row, 0.06, NOISE).expect("a range");
        let noise = weakened(&weighed, &config).expect("it is beyond half a deviation");
        assert!((noise - NOISE * 0.06 / 0.05).abs() < 1e-9, "{noise}");
    }

    /// A configuration with a gate at five standard deviations, and with learning.
    fn gated() -> Config<f64> {
        let config = Config::calibrated(1.0);
        Config { range_sigma: NOISE.sqrt(), huber: None, ..config }
    }

    #[test]
    fn a_range_that_is_wild_for_a_while_is_followed_or_blocked() {
        let config = gated();
        for (excess, agree) in [(3.0, true), (3.0, false), (-3.0, true), (-3.0, false)] {
            let blocked = excess > 0.0 && agree;
            let mut link = link(&config);
            for _ in 0..20 {
                assert_eq!(taken(&mut link, &config, excess, agree), (Outcome::Rejected, 0.0));
                assert!(!link.is_blocked);
            }
            let (outcome, moved) = taken(&mut link, &config, excess, agree);
            assert_eq!(link.is_blocked, blocked);
            if blocked {
                assert_eq!((outcome, moved), (Outcome::Rejected, 0.0));
            } else {
                assert_eq!(outcome, Outcome::Recovered);
                assert!(moved / excess > 0.9, "{moved}");
            }
            assert_eq!(taken(&mut link, &config, 0.1, agree).0, Outcome::Taken);
            assert!(!link.is_blocked, "nothing is in the way any more");
        }
        assert_eq!(taken(&mut link(&config), &config, 4.9 * DEVIATION, true).0, Outcome::Taken);
        assert_eq!(taken(&mut link(&config), &config, 5.1 * DEVIATION, true).0, Outcome::Rejected);
        let open = Config { gate: None, ..config };
        assert_eq!(taken(&mut link(&open), &open, 100.0, true).0, Outcome::Taken);
    }

    /// The variance of an anchor's ranges after a single range.
    fn learnt(excess: f64, known: Known) -> f64 {
        let config = gated();
        let mut link = link(&config);
        let observation =
            LinearObservation { row: SparseRow::new([(0, 1.0)]), measured: 5.0 + excess };
        take_in(&mut estimate(), &mut link, &observation, &config, known, || true)
            .expect("a range");
        link.noise.variance()
    }

    #[test]
    fn an_anchors_noise_is_learnt_where_others_tell_the_place() {
        assert!((learnt(0.9, Known { is_redundant: false, ..MOVING }) - NOISE).abs() < 1e-12);
        // A hundredth of the squared residual, and of the uncertainty of the estimate.
        let share = NOISE / (SPREAD + NOISE);
        let learns =
            |excess: f64| 0.99 * NOISE + 0.01 * ((excess * share).powi(2) + SPREAD * share);
        assert!((learnt(0.9, MOVING) - learns(0.9)).abs() < 1e-9);
        // An outlier counts no more than what the gate admits.
        for excess in [5.1 * DEVIATION, 100.0] {
            assert!((learnt(excess, MOVING) - learns(5.0 * DEVIATION)).abs() < 1e-9, "{excess}");
        }
        // While the tag is said to stand, a range may become better than at the beginning, but not worse.
        let standing = Known { is_still: true, ..MOVING };
        assert!((learnt(0.9, standing) - NOISE).abs() < 1e-12);
        assert!((learnt(0.0, standing) - learns(0.0)).abs() < 1e-9);
        let from = |variance: f64, excess: f64| {
            let config = gated();
            let mut link = link(&config);
            link.noise = MeasurementNoise::new(variance);
            let observation =
                LinearObservation { row: SparseRow::new([(0, 1.0)]), measured: 5.0 + excess };
            let known = standing;
            take_in(&mut estimate(), &mut link, &observation, &config, known, || true)
                .expect("a range");
            link.noise.variance()
        };
        assert!(from(0.5 * NOISE, 0.0) < 0.5 * NOISE && from(0.5 * NOISE, 0.9) > 0.5 * NOISE);
        // Noise learnt of a bad anchor is not forgotten while standing.
        assert!((from(4.0 * NOISE, 0.0) - 4.0 * NOISE).abs() < 1e-12);
    }
}
