use crate::{Config, Error, RangeSample};
use kestirim_adaptive_kalman::MeasurementNoise;
use kestirim_kalman::Gate;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// An anchor: where it is, and by how much it measures too long.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Anchor<T: Scalar> {
    /// Position in the room's axes (right-handed, z up), m.
    pub position: SVector<T, 3>,
    /// Bias of its ranges, m: what they are too long by; zero if that is not known.
    pub bias: T,
}

impl<T: Scalar> Anchor<T> {
    /// Refuses an anchor whose position or bias is not finite.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let numbers = self.position.iter().chain([&self.bias]);
        if numbers.copied().all(T::is_finite) { Ok(()) } else { Err(Error::NotFinite) }
    }
}

/// How often ranges come, and so how old one may be that is still used.
///
/// A radio that asks six anchors in turn, five times in two seconds, hears each every 2.6 s: a second, which is right where
/// ranges come in dozens, would never see three of them together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    /// Time of the newest range (µs); 0 before the first.
    last_us: u64,
    /// Anchor of the last range.
    last: usize,
    /// Mean time between two ranges of any anchors (µs), mostly over the last sixteen.
    mean_us: u32,
    fresh_us: u64,
}

impl Pace {
    /// Age up to which a range is always used (µs), …
    const LEAST_US: u64 = 1_000_000;
    /// … and beyond which it never is.
    pub(crate) const MOST_US: u64 = 8_000_000;
    /// An outage is not slowness: a longer interval counts as this one (µs).
    const LONGEST_US: u64 = 2_000_000;
    /// So many rounds of all anchors are fresh: one may be missed.
    const ROUNDS: u64 = 2;

    pub(crate) const fn new() -> Self {
        Self { last_us: 0, last: 0, mean_us: 0, fresh_us: Self::LEAST_US }
    }

    /// Takes notice of a range of an anchor, one of so many `anchors`.
    #[inline]
    pub(crate) fn hear(&mut self, time_us: u64, anchor: usize, anchors: usize) {
        self.last = anchor;
        let interval_us = time_us.saturating_sub(self.last_us).min(Self::LONGEST_US) as u32;
        let is_first = self.last_us == 0;
        self.last_us = self.last_us.max(time_us);
        if is_first {
            return;
        }
        self.mean_us = if self.mean_us == 0 {
            interval_us
        } else {
            self.mean_us - (self.mean_us >> 4) + (interval_us >> 4)
        };
        let round_us = u64::from(self.mean_us).saturating_mul(anchors as u64);
        self.fresh_us = round_us.saturating_mul(Self::ROUNDS).clamp(Self::LEAST_US, Self::MOST_US);
    }

    /// Whether the last range was this anchor's: some radios ask each twice.
    pub(crate) const fn is_last(&self, anchor: usize) -> bool {
        self.last_us > 0 && self.last == anchor
    }

    /// Age beyond which a range is not used (µs).
    #[inline(always)]
    pub(crate) const fn fresh_us(&self) -> u64 {
        self.fresh_us
    }
}

/// An anchor, its last range, and the noise and gate of its ranges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link<T: Scalar> {
    pub(crate) anchor: Anchor<T>,
    pub(crate) noise: MeasurementNoise<T>,
    pub(crate) gate: Gate<T>,
    /// From this time on a range is new (µs); 0 if none came yet.
    next_us: u64,
    /// The last range, freed of its bias, m.
    range: T,
    /// Whether it has measured too long for a while, when others agreed: something stands in its way.
    pub(crate) is_blocked: bool,
}

impl<T: Scalar> Link<T> {
    /// Number of ranges in a row that do not fit after which one is taken in all the same.
    const PATIENCE: u16 = 20;

    pub(crate) fn new(anchor: Anchor<T>, config: &Config<T>) -> Self {
        Self {
            anchor,
            noise: MeasurementNoise::new(config.range_sigma * config.range_sigma),
            gate: Gate::new(config.gate.unwrap_or(T::MAX), Self::PATIENCE),
            next_us: 0,
            range: T::ZERO,
            is_blocked: false,
        }
    }

    /// The range, freed of its bias, if it is no older than `fresh_us` at `time_us`, and its age (µs).
    #[inline]
    pub(crate) fn fresh(&self, time_us: u64, fresh_us: u64) -> Option<(T, u64)> {
        let age_us = time_us.saturating_add(1).saturating_sub(self.next_us);
        (self.next_us > 0 && age_us <= fresh_us).then_some((self.range, age_us))
    }

    /// The range of a sample, freed of its bias, if it can be one and is new.
    #[inline]
    pub(crate) fn admit(&self, sample: &RangeSample<T>) -> Result<T, Error> {
        sample.check()?;
        if sample.time_us < self.next_us {
            let again = sample.time_us == self.next_us - 1;
            return Err(if again { Error::Duplicate } else { Error::OutOfOrder });
        }
        Ok(sample.range - self.anchor.bias)
    }

    /// Keeps a range, freed of its bias.
    #[inline]
    pub(crate) fn hear(&mut self, time_us: u64, range: T) {
        self.next_us = time_us.wrapping_add(1);
        self.range = range;
    }

    /// The same link for a new estimate: noise and gate begin anew.
    pub(crate) fn begun(&self, config: &Config<T>) -> Self {
        Self { next_us: self.next_us, range: self.range, ..Self::new(self.anchor, config) }
    }
}
