//! The clocks of satellites and receivers.

use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use rand_core::Rng;

use super::times::{EPOCHS, INTERVAL_S, LAST, SAMPLES};
use crate::random::{normal, uniform};

/// The random walk of the satellites' clocks, m/√s: from the newest to the oldest rubidium.
const WALK: [f64; 2] = [0.5e-3, 3e-3];
/// The step by which receivers reset their clock, s, whenever it is off by more than half of it.
const MILLISECOND: f64 = 1e-3;
/// The number of clock jumps a day, and the largest jump, s.
const JUMPS_A_DAY: f64 = 3.0;
const LARGEST_JUMP: f64 = 300e-9;

/// A satellite's clock, sampled at the times of the products and interpolated linearly.
#[derive(Debug, Clone)]
pub(super) struct SatelliteClock(Vec<f64>);

impl SatelliteClock {
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        let walk = WALK[0] + (WALK[1] - WALK[0]) * uniform(rng);
        let step = walk * INTERVAL_S.sqrt() / SPEED_OF_LIGHT;
        let drift = normal(rng, 3e-12) * INTERVAL_S;
        let mut bias = normal(rng, 2e-4);
        let samples = (0..SAMPLES).map(|_| {
            bias += drift + normal(rng, step);
            bias
        });
        Self(samples.collect())
    }

    /// The offsets from GPS time at the samples, s; positive if the clock is ahead.
    pub(super) fn samples(&self) -> &[f64] {
        &self.0
    }

    /// The offset from GPS time, s, at any second since midnight within the samples.
    pub(super) fn at(&self, second: f64) -> f64 {
        let place = second / INTERVAL_S + LAST;
        let below = place as usize;
        let share = place - below as f64;
        self.0[below] + share * (self.0[below + 1] - self.0[below])
    }
}

/// A receiver's clock.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReceiverClock {
    /// The offset from GPS time, s; positive if the clock is ahead.
    bias: f64,
    /// The rate of the offset, s/s.
    rate: f64,
    /// The random walk of the rate in one epoch.
    rate_walk: f64,
    /// The random walk of the offset in one epoch, s.
    walk: f64,
}

impl ReceiverClock {
    /// Draws a clock: half of them are steered by masers, half are quartz.
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        let quartz = uniform(rng) < 0.5;
        Self {
            bias: normal(rng, if quartz { 2e-4 } else { 1e-7 }),
            rate: normal(rng, if quartz { 1e-7 } else { 1e-14 }),
            rate_walk: if quartz { 1e-10 } else { 0.0 },
            walk: if quartz { 1e-9 } else { 3e-12 },
        }
    }

    /// Advances by one epoch and returns the offset, s.
    pub(super) fn next(&mut self, rng: &mut impl Rng) -> f64 {
        self.rate += normal(rng, self.rate_walk);
        self.bias += self.rate * INTERVAL_S + normal(rng, self.walk);
        if uniform(rng) < JUMPS_A_DAY / f64::from(EPOCHS) {
            self.bias += LARGEST_JUMP * (2.0 * uniform(rng) - 1.0);
        }
        if self.bias.abs() > 0.5 * MILLISECOND {
            self.bias -= MILLISECOND.copysign(self.bias);
        }
        self.bias
    }
}
