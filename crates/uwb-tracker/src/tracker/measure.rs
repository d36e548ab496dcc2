//! Updates of the estimate by ranges.

use super::Tracker;
use crate::measurement::Range;
use crate::start::start;
use crate::{Config, Error, Outcome, RangeSample, Report};
use kestirim_kalman::{Verdict, Weighed};
use kestirim_scalar::Scalar;

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// After so many tries to begin, ranges that contradict each other are accepted, too.
    const TRIES: u8 = 20;

    /// Takes in a range at the estimate's own time.
    #[inline(always)]
    pub(super) fn measure(
        &mut self,
        sample: &RangeSample<T>,
        range: T,
    ) -> Result<Report<T>, Error> {
        let link = self.links.get_mut(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        let Some(estimate) = &mut self.estimate else {
            return Ok(self.collect(sample, range));
        };
        let observes_bias = N > 2 * D && self.heard as usize >= D + 2;
        let observation = Range::<T, D> {
            measured: range,
            anchor: &link.anchor.position,
            height: self.config.height,
            observes_bias,
        };
        let weighed = estimate.weigh_observation(&observation, link.noise.variance())?;
        let seen = weighed.report();

        let mut gate = link.gate;
        let verdict =
            if self.config.gate.is_some() { gate.judge(&weighed) } else { Verdict::Admit };
        let believed = gate.gamma() * weighed.variance();
        let (outcome, square) = match verdict {
            Verdict::Admit => {
                let square = weighed.innovation() * weighed.innovation();
                if let Some(noise) = weakened(&weighed, &self.config) {
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
        link.hear(sample.time_us, range);
        // A range that the estimate has to follow fits whatever it is worth.
        let redundant = self.heard as usize > D + usize::from(observes_bias);
        if redundant && let Some(learning) = &self.config.learning {
            link.noise.learn_square(learning, &weighed, square);
        }
        if outcome == Outcome::Rejected {
            self.reject();
        } else {
            self.counters.take(seen.nis);
        }
        Ok(Report { outcome, innovation: Some(seen) })
    }

    /// Counts a range that was left out; when half of them are, the position is given up.
    pub(super) fn reject(&mut self) {
        self.counters.reject();
        if self.counters.distrust > 2 * u16::from(self.heard.max(D as u8)) {
            self.estimate = None;
        }
    }

    /// Keeps a range for a first position, and makes one if it can.
    #[inline(never)] // Rare, and large.
    pub(super) fn collect(&mut self, sample: &RangeSample<T>, range: T) -> Report<T> {
        let mut again = false;
        if let Some(link) = self.links.get_mut(sample.anchor) {
            again = link.fresh(self.time_us).is_some();
            link.hear(sample.time_us, range);
        }
        let started = self.begin(self.time_us, again);
        let outcome = if started { Outcome::Started } else { Outcome::Collected };
        Report { outcome, innovation: None }
    }

    /// Makes a position of the fresh ranges, if they are enough: when all anchors have been heard, or
    /// one of them `again`, before the others.
    pub(super) fn begin(&mut self, now_us: u64, again: bool) -> bool {
        if !again && usize::from(self.count_heard(now_us)) < self.links.len() {
            return false;
        }
        let patience = self.counters.tries < Self::TRIES;
        self.counters.tries = self.counters.tries.saturating_add(1);
        self.estimate = start::<T, D, N, A>(&self.config, &self.links, now_us, patience);
        if self.estimate.is_none() {
            return false;
        }
        self.counters.tries = 0;
        for link in &mut self.links {
            *link = link.begun(&self.config);
        }
        self.heard = self.count_heard(now_us);
        self.counters.starts = self.counters.starts.saturating_add(1);
        self.counters.distrust = 0;
        self.counters.nis = T::ONE;
        true
    }
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
