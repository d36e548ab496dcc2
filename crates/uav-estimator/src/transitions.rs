use nalgebra::SVector;

use crate::{Dynamics, Error, Step};

/// A model that can be discretised over any interval.
pub(crate) trait Moves {
    /// The model's step over an interval.
    type Step;

    /// The step over `interval` (s), with white noise of the standard deviations `noise` per `sample` (s) on the
    /// inputs.
    fn over(
        &self,
        interval: f64,
        sample: f64,
        noise: &SVector<f64, 2>,
    ) -> Result<Self::Step, Error>;
}

impl Moves for Dynamics {
    type Step = Step;

    fn over(&self, interval: f64, sample: f64, noise: &SVector<f64, 2>) -> Result<Step, Error> {
        Self::over(self, interval, sample, noise)
    }
}

/// Longest time over which an estimate is predicted, in usual intervals.
const LONGEST_GAP: f64 = 1e6;
/// Time after which samples that are no whole number of a discrete-time model's steps away are not refused any longer,
/// in usual intervals.
const PATIENCE: f64 = 10.0;

/// A cache of a model's steps over the intervals between samples: the last one for each remainder of the interval in
/// µs modulo L.
///
/// Intervals that jitter by less than L µs have a slot each, so that nothing is computed twice.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "D: serde::Serialize, S: serde::Serialize",
        deserialize = "D: serde::Deserialize<'de>, S: Copy + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Transitions<D, S, const L: usize> {
    dynamics: D,
    /// Usual interval, s.
    usual: f64,
    /// Standard deviations of the inputs' noise per usual interval.
    noise: SVector<f64, 2>,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    known: [Option<(i64, S)>; L],
}

impl<D: Moves, S: Copy, const L: usize> Transitions<D, S, L> {
    pub(crate) fn new(dynamics: D, usual: f64, noise: SVector<f64, 2>) -> Self {
        Self { dynamics, usual, noise, known: [None; L] }
    }

    /// Changes the usual interval (s), which clears the cache.
    pub(crate) fn set_usual(&mut self, usual: f64) {
        self.usual = usual;
        self.known = [None; L];
    }

    /// The time between two samples (µs) and the step over it, converted by `form`. `None` if no step leads there, and
    /// the estimate begins anew: the clock was set back, the time is too long, or a discrete-time model's samples have
    /// been off its steps for a while.
    pub(crate) fn between(
        &self,
        before_us: i64,
        now_us: i64,
        form: impl FnOnce(&D::Step) -> S,
    ) -> Result<Option<(i64, S)>, Error> {
        if is_set_back(before_us, now_us) {
            return Ok(None);
        }
        let interval_us = now_us.checked_sub(before_us).filter(|interval| *interval > 0);
        let interval_us = interval_us.ok_or(Error::OutOfOrder)?;
        if let Some(Some((known_us, step))) = self.known.get(Self::place(interval_us))
            && *known_us == interval_us
        {
            return Ok(Some((interval_us, *step)));
        }
        let interval = interval_us as f64 / 1e6;
        if interval > LONGEST_GAP * self.usual {
            return Ok(None);
        }
        match self.dynamics.over(interval, self.usual, &self.noise) {
            Ok(step) => Ok(Some((interval_us, form(&step)))),
            Err(Error::WrongInterval { .. }) if interval > PATIENCE * self.usual => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Caches the step of an interval.
    pub(crate) fn keep(&mut self, interval_us: i64, step: &S) {
        if let Some(place) = self.known.get_mut(Self::place(interval_us)) {
            *place = Some((interval_us, *step));
        }
    }

    fn place(interval_us: i64) -> usize {
        const { assert!(L > 0, "one step at least is kept") };
        (interval_us as u64 % L as u64) as usize
    }
}

/// A sample older than the previous one by more than this (µs) means that the clock was set back.
const SET_BACK_US: i64 = 1_000_000;

/// Whether a sample is so much older than the previous one that the clock was set back. Otherwise a single time stamp
/// far in the future would be the last one accepted.
fn is_set_back(before_us: i64, now_us: i64) -> bool {
    before_us.saturating_sub(now_us) > SET_BACK_US
}
