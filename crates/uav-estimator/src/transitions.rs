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

/// Longest gap, in usual intervals.
const LONGEST_GAP: f64 = 1e6;

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

    /// The step over `interval_us` (µs), converted by `form`.
    pub(crate) fn over(
        &self,
        interval_us: i64,
        form: impl FnOnce(&D::Step) -> S,
    ) -> Result<S, Error> {
        if let Some(Some((known_us, step))) = self.known.get(Self::place(interval_us))
            && *known_us == interval_us
        {
            return Ok(*step);
        }
        let interval = interval_us as f64 / 1e6;
        if interval > LONGEST_GAP * self.usual {
            return Err(Error::Gap(interval));
        }
        Ok(form(&self.dynamics.over(interval, self.usual, &self.noise)?))
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
pub(crate) fn is_set_back(before_us: i64, now_us: i64) -> bool {
    before_us.saturating_sub(now_us) > SET_BACK_US
}

/// The time between two samples, µs.
pub(crate) fn interval_us(before_us: i64, now_us: i64) -> Result<i64, Error> {
    let interval = now_us.checked_sub(before_us).filter(|interval| *interval > 0);
    interval.ok_or(Error::OutOfOrder)
}
