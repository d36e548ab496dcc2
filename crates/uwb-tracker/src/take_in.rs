//! How a range is weighed, judged, taken in and learnt from: the same for every tracker.

use crate::link::Link;
use crate::{Config, Error, Outcome};
use kestirim_kalman::{Gaussian, Innovation, Observation, Verdict, Weighed};
use kestirim_scalar::Scalar;

/// Takes a range in, or leaves it out. Ranges that are too long again and again are those of an anchor that is blocked
/// where the others agree, and else of an estimate that is wrong. The anchor's noise is learnt where there are more ranges than unknowns
/// (`redundant`): a range that the estimate has to follow fits whatever it is worth.
///
/// # Errors
/// [`Error::Estimate`]; estimate and link are as they were.
#[inline(always)]
pub(crate) fn take_in<T: Scalar, const N: usize>(
    estimate: &mut Gaussian<T, N>,
    link: &mut Link<T>,
    observation: &impl Observation<T, N>,
    config: &Config<T>,
    redundant: bool,
    others_agree: impl Fn() -> bool,
) -> Result<(Outcome, Innovation<T>), Error> {
    let weighed = estimate.weigh_observation(observation, link.noise.variance())?;
    let seen = weighed.report();
    let mut gate = link.gate;
    let verdict = if config.gate.is_some() { gate.judge(&weighed) } else { Verdict::Admit };
    let believed = gate.gamma() * weighed.variance();
    let (outcome, square) = match verdict {
        Verdict::Admit => {
            link.is_blocked = false;
            let square = weighed.innovation() * weighed.innovation();
            if let Some(noise) = weakened(&weighed, config) {
                estimate.correct(&weighed.with_noise(noise)?)?;
                (Outcome::Weakened, square)
            } else {
                estimate.correct(&weighed)?;
                (Outcome::Taken, square)
            }
        }
        Verdict::Reject => (Outcome::Rejected, believed),
        Verdict::Recover if weighed.innovation() > T::ZERO && others_agree() => {
            link.is_blocked = true;
            (Outcome::Rejected, believed)
        }
        Verdict::Recover => {
            // Fixed point cannot widen without end; then the estimate is given up sooner or later.
            let widened = estimate.correct_widened(&weighed, gate.gamma()).is_ok();
            (if widened { Outcome::Recovered } else { Outcome::Rejected }, believed)
        }
    };
    link.gate = gate;
    if redundant && let Some(learning) = &config.learning {
        link.noise.learn_square(learning, &weighed, square);
    }
    Ok((outcome, seen))
}

/// The noise that Huber gives a range beyond his threshold: S grows to S |ν|/limit.
///
/// What is too long is doubted sooner than what is too short, because of what may be in the way; but not for what the
/// tag itself may have done since it was last seen, which is as likely to lengthen as to shorten. So the limit is at k√R and
/// no less than one deviation of the expected range.
#[inline(always)]
fn weakened<T: Scalar, const N: usize>(weighed: &Weighed<T, N>, config: &Config<T>) -> Option<T> {
    let huber = config.huber.as_ref()?;
    let threshold = huber.threshold(weighed.innovation());
    let square = threshold * threshold;
    // The limit is no less than this; most ranges are within it.
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
