//! Clocks of satellites and of receivers.

use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use rand_core::Rng;

use super::times::{EPOCHS, INTERVAL_S, LAST, SAMPLES};
use crate::random::{normal, uniform};

/// How fast the clocks of satellites walk, m/√s: from the newest to the oldest rubidium.
const WALK: [f64; 2] = [0.5e-3, 3e-3];
/// Receivers let their clock run up to this, s, and then put it back by a millisecond.
const MILLISECOND: f64 = 1e-3;
/// Clocks are put elsewhere a few times a day, by up to so much, s.
const JUMPS_A_DAY: f64 = 3.0;
const LARGEST_JUMP: f64 = 300e-9;

/// A satellite's clock, on the samples of the products; straight between them.
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

    /// Ahead of GPS time on the samples, s.
    pub(super) fn samples(&self) -> &[f64] {
        &self.0
    }

    /// The same at any second since midnight within them.
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
    /// Ahead of GPS time, s.
    bias: f64,
    /// s/s.
    rate: f64,
    /// How much the rate changes in an epoch.
    rate_walk: f64,
    /// How much the bias walks in an epoch, s.
    walk: f64,
}

impl ReceiverClock {
    /// Half of them steered by masers, half quartz.
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        let quartz = uniform(rng) < 0.5;
        Self {
            bias: normal(rng, if quartz { 2e-4 } else { 1e-7 }),
            rate: normal(rng, if quartz { 1e-7 } else { 1e-14 }),
            rate_walk: if quartz { 1e-10 } else { 0.0 },
            walk: if quartz { 1e-9 } else { 3e-12 },
        }
    }

    /// Lets an epoch pass.
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
