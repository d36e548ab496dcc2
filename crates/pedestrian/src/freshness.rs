use crate::ImuSample;
use crate::detector::Motion;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// How long a sensor has been repeating its values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Freshness<T: Scalar> {
    force: SVector<T, 3>,
    rate: SVector<T, 3>,
    /// When they were new (µs).
    force_us: u32,
    rate_us: u32,
}

/// What a sample is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Worth {
    /// A measurement, whose values are new or could be.
    New {
        /// All six values have been the same for a while.
        frozen: bool,
        /// They were, for longer than is integrated, and then jumped: what came between was not measured.
        resumed: bool,
    },
    /// Not a measurement: no force at all, and be it only that of the air, is never felt.
    Zero,
    /// A moving foot of which the gyroscope knows nothing new.
    Stuck,
}

impl<T: Scalar> Freshness<T> {
    /// A gyroscope of a moving foot does not show the same three values for longer (µs).
    const STUCK_US: u32 = 100_000;
    /// What all six axes repeat for longer may be no standstill (µs).
    const FROZEN_US: u32 = 200_000;
    /// No sensor without noise is so still for so long (µs).
    const TOLD_US: u32 = 500_000;
    /// A foot that stood does not turn so fast (rad/s) …
    const RATE_JUMP: f64 = 0.5;
    /// … nor is it pushed so much (m/s²) in the next sample.
    const FORCE_JUMP: f64 = 2.0;
    /// A foot at rest turns no faster, (rad/s)² …
    const REST_RATE_SQUARE: f64 = 0.1;
    /// … and feels gravity; its square is within this of 1 g².
    const REST_EXCESS: f64 = 0.3;

    pub(crate) fn new() -> Self {
        let never = SVector::from([T::MAX; 3]);
        Self { force: never, rate: never, force_us: 0, rate_us: 0 }
    }

    /// Takes a sample and its motion.
    #[inline]
    pub(crate) fn update(&mut self, sample: &ImuSample<T>, motion: &Motion<T>) -> Worth {
        let (force, rate) = (sample.specific_force, sample.angular_rate);
        let time_us = sample.time_us as u32;
        if force.as_array().iter().all(|component| *component == T::ZERO) {
            return Worth::Zero;
        }
        let (new_force, new_rate) = (force != self.force, rate != self.rate);
        let mut resumed = false;
        if new_force || new_rate {
            resumed = self.frozen_us(time_us) > Self::FROZEN_US && self.jumps(sample);
        }
        if new_force {
            self.force = force;
            self.force_us = time_us;
        }
        if new_rate {
            self.rate = rate;
            self.rate_us = time_us;
        } else if time_us.wrapping_sub(self.rate_us) > Self::STUCK_US && !Self::at_rest(motion) {
            return Worth::Stuck;
        }
        Worth::New { frozen: self.frozen_us(time_us) > Self::FROZEN_US, resumed }
    }

    /// Whether the sensor has repeated itself for so long that it has to be told.
    pub(crate) fn is_stuck(&self, time_us: u64) -> bool {
        self.frozen_us(time_us as u32) > Self::TOLD_US
    }

    /// For how long all six values have been the same (µs).
    #[inline]
    fn frozen_us(&self, time_us: u32) -> u32 {
        time_us.wrapping_sub(self.force_us).min(time_us.wrapping_sub(self.rate_us))
    }

    #[cold]
    fn jumps(&self, sample: &ImuSample<T>) -> bool {
        let beyond = |step: SVector<T, 3>, limit: f64| {
            step.as_array().iter().any(|component| component.abs() > T::from_f64(limit))
        };
        beyond(sample.angular_rate - self.rate, Self::RATE_JUMP)
            || beyond(sample.specific_force - self.force, Self::FORCE_JUMP)
    }

    #[cold]
    fn at_rest(motion: &Motion<T>) -> bool {
        let (force, rate) = (motion.force_g.as_array(), motion.angular_rate.as_array());
        T::dot(rate, rate) < T::from_f64(Self::REST_RATE_SQUARE)
            && (T::dot(force, force) - T::ONE).abs() < T::from_f64(Self::REST_EXCESS)
    }
}
