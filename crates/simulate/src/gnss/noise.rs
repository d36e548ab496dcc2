//! Coloured noise.

use rand_core::Rng;

use super::times::INTERVAL_S;
use crate::random::normal;

/// A number that wanders about zero with unit variance (a Gauss–Markov process), from epoch to epoch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wander {
    value: f64,
    keeps: f64,
}

impl Wander {
    /// One whose correlation falls to 1/e after `memory_s`.
    pub(super) fn draw(memory_s: f64, rng: &mut impl Rng) -> Self {
        Self { value: normal(rng, 1.0), keeps: (-INTERVAL_S / memory_s).exp() }
    }

    /// Its next value.
    pub(super) fn next(&mut self, rng: &mut impl Rng) -> f64 {
        let fresh = (1.0 - self.keeps * self.keeps).sqrt();
        self.value = self.keeps * self.value + normal(rng, fresh);
        self.value
    }
}

/// A standard deviation that grows towards the horizon, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spread {
    /// At the zenith.
    pub(super) zenith: f64,
    /// What the horizon adds.
    pub(super) horizon: f64,
}

impl Spread {
    /// At an elevation, rad.
    pub(super) fn at(&self, elevation: f64) -> f64 {
        // Antennas see reflections and little signal below some 10°.
        self.zenith + self.horizon * (-elevation / 0.17).exp()
    }
}
