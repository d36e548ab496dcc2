use crate::{Config, Error};
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

/// Age beyond which a range is not used (µs).
pub(crate) const FRESH_US: u64 = 1_000_000;

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
        }
    }

    /// The range, freed of its bias, if it is fresh at `time_us`.
    #[inline]
    pub(crate) fn fresh(&self, time_us: u64) -> Option<T> {
        let age_us = time_us.saturating_add(1).saturating_sub(self.next_us);
        (self.next_us > 0 && age_us <= FRESH_US).then_some(self.range)
    }

    /// From when on a range is new (µs).
    #[inline]
    pub(crate) fn next_us(&self) -> u64 {
        self.next_us
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
