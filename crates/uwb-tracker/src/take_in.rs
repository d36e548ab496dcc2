//! How a range is weighed, judged, taken in and learnt from: the same for every tracker.

use crate::link::Link;
use crate::{Config, Error, Outcome};
use kestirim_kalman::{Gaussian, Innovation, Observation, Verdict, Weighed};
use kestirim_scalar::Scalar;

/// Takes a range in, or leaves it out. Its anchor's noise is learnt where there are more ranges than unknowns
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
) -> Result<(Outcome, Innovation<T>), Error> {
    let weighed = estimate.weigh_observation(observation, link.noise.variance())?;
    let seen = weighed.report();
    let mut gate = link.gate;
    let verdict = if config.gate.is_some() { gate.judge(&weighed) } else { Verdict::Admit };
    let believed = gate.gamma() * weighed.variance();
    let (outcome, square) = match verdict {
        Verdict::Admit => {
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

/// The noise that Huber gives a range beyond his threshold: S grows to S |ν|/(k √S).
#[inline(always)]
fn weakened<T: Scalar, const N: usize>(weighed: &Weighed<T, N>, config: &Config<T>) -> Option<T> {
    let huber = config.huber.as_ref()?;
    let threshold = huber.threshold(weighed.innovation());
    if !weighed.exceeds(threshold * threshold) {
        return None;
    }
    let variance = weighed.innovation().abs() * weighed.variance().sqrt() / threshold;
    Some((variance - weighed.spread()).max(weighed.noise()))
}
