use crate::{Config, Error, RangeSample};
use kestirim_adaptive_kalman::MeasurementNoise;
use kestirim_kalman::Gate;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// An anchor, with its position and range bias.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Anchor<T: Scalar> {
    /// Position in the room frame (right-handed, z up), m.
    pub position: SVector<T, 3>,
    /// Bias of its ranges, m, positive if they are too long; zero if unknown.
    pub bias: T,
}

impl<T: Scalar> Anchor<T> {
    /// Checks that position and bias are finite.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let numbers = self.position.iter().chain([&self.bias]);
        if numbers.copied().all(T::is_finite) { Ok(()) } else { Err(Error::NotFinite) }
    }
}

/// An anchor, its last range, and the noise and gate of its ranges.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Link<T: Scalar> {
    pub(crate) anchor: Anchor<T>,
    pub(crate) noise: MeasurementNoise<T>,
    pub(crate) gate: Gate<T>,
    /// Time from which on a range counts as new, µs; 0 before the first one.
    next_us: u64,
    /// The last range, without its bias, m.
    range: T,
    /// Whether an obstacle is assumed: its ranges have been too long for a while, when others were consistent.
    pub(crate) is_blocked: bool,
}

impl<T: Scalar> Link<T> {
    /// Number of successive rejections after which a range is used in any case.
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

    /// The range without its bias, and its age (µs), if it is no older than `fresh_us` at `time_us`.
    #[inline]
    pub(crate) fn fresh(&self, time_us: u64, fresh_us: u64) -> Option<(T, u64)> {
        let age_us = time_us.saturating_add(1).saturating_sub(self.next_us);
        (self.next_us > 0 && age_us <= fresh_us).then_some((self.range, age_us))
    }

    /// Whether the last range arrived at this very time.
    pub(crate) fn is_heard_at(&self, time_us: u64) -> bool {
        self.is_heard() && self.next_us == time_us.wrapping_add(1)
    }

    /// The last range, without its bias, m; zero before the first one.
    #[inline]
    pub(crate) fn last(&self) -> T {
        self.range
    }

    /// Whether any range has arrived.
    #[inline]
    pub(crate) fn is_heard(&self) -> bool {
        self.next_us > 0
    }

    /// The range of a sample without its bias, if it is plausible and new.
    #[inline]
    pub(crate) fn admit(&self, sample: &RangeSample<T>) -> Result<T, Error> {
        sample.check()?;
        if sample.time_us < self.next_us {
            let again = sample.time_us == self.next_us - 1;
            return Err(if again { Error::Duplicate } else { Error::OutOfOrder });
        }
        Ok(sample.range - self.anchor.bias)
    }

    /// Stores a range, given without its bias.
    #[inline]
    pub(crate) fn hear(&mut self, time_us: u64, range: T) {
        self.next_us = time_us.wrapping_add(1);
        self.range = range;
    }

    /// Forgets the last range, as if none had arrived.
    pub(crate) fn forget(&mut self) {
        self.next_us = 0;
    }

    /// Adds an offset to the last range, m.
    pub(crate) fn shift(&mut self, by: T) {
        self.range += by;
    }

    /// The link for a new estimate, with reset noise and gate.
    pub(crate) fn begun(&self, config: &Config<T>) -> Self {
        Self { next_us: self.next_us, range: self.range, ..Self::new(self.anchor, config) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BIAS: f64 = 0.5;

    fn link() -> Link<f64> {
        let anchor = Anchor { position: SVector::zeros(), bias: BIAS };
        Link::new(anchor, &Config::calibrated(1.0))
    }

    #[test]
    fn a_range_is_fresh_up_to_an_age() {
        let mut link = link();
        assert!(!link.is_heard());
        assert_eq!(link.fresh(0, 1000), None);
        link.hear(5000, 3.0);
        assert!(link.is_heard());
        assert_eq!(link.fresh(5000, 1000), Some((3.0, 0)));
        assert_eq!(link.fresh(6000, 1000), Some((3.0, 1000)));
        assert_eq!(link.fresh(6001, 1000), None);
        // A late range of another anchor refers to an earlier time.
        assert_eq!(link.fresh(4000, 1000), Some((3.0, 0)));
    }

    #[test]
    fn a_range_is_admitted_once_and_without_its_bias() {
        let mut link = link();
        let sample = |time_us| RangeSample { time_us, anchor: 0, range: 3.0 + BIAS };
        assert_eq!(link.admit(&sample(0)), Ok(3.0));
        link.hear(5000, 3.0);
        assert_eq!(link.admit(&sample(5001)), Ok(3.0));
        assert_eq!(link.admit(&sample(5000)), Err(Error::Duplicate));
        assert_eq!(link.admit(&sample(4999)), Err(Error::OutOfOrder));
        assert_eq!(link.admit(&sample(0)), Err(Error::OutOfOrder));
    }

    #[test]
    fn a_new_estimate_keeps_the_range_and_nothing_else() {
        let config = Config::calibrated(1.0);
        let mut link = link();
        link.hear(5000, 3.0);
        (link.noise, link.is_blocked) = (MeasurementNoise::new(9.0), true);
        let begun = link.begun(&config);
        assert_eq!(begun.fresh(5000, 0), Some((3.0, 0)));
        assert!(!begun.is_blocked);
        assert_eq!(begun.noise.variance(), config.range_sigma * config.range_sigma);
    }

    #[test]
    fn an_anchor_is_somewhere() {
        let anchor = link().anchor;
        assert_eq!(anchor.check(), Ok(()));
        assert_eq!(Anchor { bias: f64::NAN, ..anchor }.check(), Err(Error::NotFinite));
        let position = SVector::from([0.0, f64::INFINITY, 0.0]);
        assert_eq!(Anchor { position, ..anchor }.check(), Err(Error::NotFinite));
    }
}
