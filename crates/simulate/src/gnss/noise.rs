//! Coloured noise.

use rand_core::Rng;

use super::times::INTERVAL_S;
use crate::random::normal;

/// A Gauss–Markov process with zero mean and unit variance, sampled at the epochs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wander {
    value: f64,
    keeps: f64,
}

impl Wander {
    /// Draws a process whose correlation falls to 1/e after `memory_s` seconds.
    pub(super) fn draw(memory_s: f64, rng: &mut impl Rng) -> Self {
        Self { value: normal(rng, 1.0), keeps: (-INTERVAL_S / memory_s).exp() }
    }

    /// Advances by one epoch and returns the new value.
    pub(super) fn next(&mut self, rng: &mut impl Rng) -> f64 {
        let fresh = (1.0 - self.keeps * self.keeps).sqrt();
        self.value = self.keeps * self.value + normal(rng, fresh);
        self.value
    }
}

/// A standard deviation that grows towards the horizon, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spread {
    /// The standard deviation at the zenith, m.
    pub(super) zenith: f64,
    /// The increase at the horizon, m.
    pub(super) horizon: f64,
}

impl Spread {
    /// The standard deviation at an elevation (rad), m.
    pub(super) fn at(&self, elevation: f64) -> f64 {
        // Antennas receive reflections and little signal below some 10°.
        self.zenith + self.horizon * (-elevation / 0.17).exp()
    }
}
