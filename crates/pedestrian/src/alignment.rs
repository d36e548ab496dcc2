use crate::ImuSample;
use crate::sensor::{Prior, SensorClass};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Standard gravity (m/s²).
pub(crate) const STANDARD_GRAVITY: f64 = 9.80665;

/// Gyro bias and what of an accelerometer bias can be seen, learnt from standstill.
///
/// The stream is cut into eighths of a second. Four in a row whose mean rates and forces agree are a
/// standstill of half a second; a stance of walking is over sooner. What it says is weighted by
/// its own spread against what the class of the sensor promises: people sway, and a good gyroscope knows
/// its zero better than a swaying foot shows it, whereas a bare chip's may be off by a hundred times that.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Alignment<T: Scalar> {
    gyro_bias: SVector<T, 3>,
    /// Variance of the bias of each axis, (0.01 rad/s)²: one number, since sway turns about every axis. (In this unit Q12.20
    /// holds the squares of both the largest bias and the smallest noise.)
    bias_variance: T,
    /// The accelerometer's magnitude at rest, in units of standard gravity.
    gravity: T,
    gravity_variance: T,
    /// m/s², body.
    accelerometer_bias: SVector<T, 3>,
    block: Block<T>,
    standstill: Standstill<T>,
}

/// Sums over an eighth of a second.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Block<T: Scalar> {
    begun_us: Option<u32>,
    count: i32,
    /// rad/s.
    rate: SVector<T, 3>,
    /// m/s².
    force: SVector<T, 3>,
}

/// Deviations of a run of blocks from the first of them.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Standstill<T: Scalar> {
    blocks: i32,
    rate: SVector<T, 3>,
    force: SVector<T, 3>,
    /// 0.01 rad/s.
    rate_sum: SVector<T, 3>,
    /// (0.01 rad/s)².
    rate_square: T,
    force_sum: SVector<T, 3>,
}

impl<T: Scalar> Block<T> {
    fn new() -> Self {
        Self { begun_us: None, count: 0, rate: SVector::zeros(), force: SVector::zeros() }
    }
}

impl<T: Scalar> Standstill<T> {
    fn from_block(rate: SVector<T, 3>, force: SVector<T, 3>) -> Self {
        Self {
            blocks: 1,
            rate,
            force,
            rate_sum: SVector::zeros(),
            rate_square: T::ZERO,
            force_sum: SVector::zeros(),
        }
    }
}

impl<T: Scalar> Alignment<T> {
    const BLOCK_US: u32 = 125_000;
    const BLOCKS: i32 = 4;
    /// Blocks further apart than this are no standstill (rad/s) …
    const RATE_SPREAD: f64 = 0.03;
    /// … nor is a rate that no bias explains (rad/s), however steady …
    const LARGEST_BIAS: f64 = 0.35;
    /// … nor forces further apart than this (g).
    const FORCE_SPREAD: f64 = 0.04;
    /// The gyroscope's own noise over a standstill (0.01 rad/s), below which no spread is believed.
    const RATE_FLOOR: f64 = 0.07;
    /// So far from gravity (g) no accelerometer is at rest: nothing is learnt there.
    const NO_GRAVITY: f64 = 0.5;
    /// The accelerometer's, relative to g.
    const FORCE_FLOOR: f64 = 0.001;
    /// A bias with more than this standard deviation is not known (0.01 rad/s).
    const UNKNOWN: f64 = 1.0;
    /// Standard deviation by which a bias wanders between two standstills (0.01 rad/s).
    const WANDER: f64 = 0.01;

    /// The state before the first sample, from the class of the sensor.
    pub(crate) fn new(sensor: SensorClass) -> Self {
        let Prior { gyro_bias, gravity } = sensor.prior();
        Self {
            gyro_bias: SVector::zeros(),
            bias_variance: T::from_f64(gyro_bias * gyro_bias * 1e4),
            gravity: T::ONE,
            gravity_variance: T::from_f64(gravity * gravity),
            accelerometer_bias: SVector::zeros(),
            block: Block::new(),
            standstill: Standstill::from_block(SVector::zeros(), SVector::zeros()),
        }
    }

    /// The gyro bias (rad/s, body).
    pub fn gyro_bias(&self) -> &SVector<T, 3> {
        &self.gyro_bias
    }

    /// The smallest accelerometer bias that explains what it shows at rest (m/s², body): along gravity. Across
    /// it, a bias cannot be told from a tilt.
    pub fn accelerometer_bias(&self) -> &SVector<T, 3> {
        &self.accelerometer_bias
    }

    /// Relative error of gravity at rest, with its standard deviation: that of the class, if it was never seen.
    pub(crate) fn gravity_off(&self) -> T {
        (self.gravity - T::ONE).hypot(self.gravity_variance.sqrt())
    }

    /// Keeps what was learnt and forgets the stream, to begin it again.
    pub(crate) fn rewound(mut self) -> Self {
        self.block = Block::new();
        self.standstill.blocks = 0;
        self
    }

    /// Takes the next sample; `Some(|f|/g₀)` when a standstill has just refined the estimates.
    pub(crate) fn update(&mut self, sample: &ImuSample<T>) -> Option<T> {
        // The lower half is enough for differences.
        let time_us = sample.time_us as u32;
        let begun_us = *self.block.begun_us.get_or_insert(time_us);
        self.block.rate += sample.angular_rate;
        self.block.force += sample.specific_force;
        self.block.count += 1;
        if time_us.wrapping_sub(begun_us) < Self::BLOCK_US {
            return None;
        }
        let reciprocal = T::ONE / T::from_micro(self.block.count.saturating_mul(1_000_000));
        let rate = self.block.rate * reciprocal;
        let force = self.block.force * reciprocal * T::from_f64(1.0 / STANDARD_GRAVITY);
        self.block = Block { begun_us: Some(time_us), ..Block::new() };
        self.join(rate, force)
    }

    fn join(&mut self, rate: SVector<T, 3>, force: SVector<T, 3>) -> Option<T> {
        let (rate_step, force_step) = (rate - self.standstill.rate, force - self.standstill.force);
        let still = largest(&rate_step) < T::from_f64(Self::RATE_SPREAD)
            && largest(&force_step) < T::from_f64(Self::FORCE_SPREAD)
            && largest(&rate) < T::from_f64(Self::LARGEST_BIAS);
        if self.standstill.blocks == 0 || !still {
            self.standstill = Standstill::from_block(rate, force);
            return None;
        }
        let step = rate_step * T::from_f64(100.0);
        let run = &mut self.standstill;
        run.blocks += 1;
        run.rate_sum += step;
        run.rate_square += T::dot(step.as_array(), step.as_array());
        run.force_sum += force_step;
        if run.blocks < Self::BLOCKS {
            return None;
        }
        let magnitude = self.learn();
        self.standstill.blocks = 0;
        Some(magnitude)
    }

    /// One scalar update of the bias and one of gravity from a whole standstill.
    fn learn(&mut self) -> T {
        let run = &self.standstill;
        let share = T::from_f64(0.25);
        let mean_step = run.rate_sum * share;
        let square = T::dot(mean_step.as_array(), mean_step.as_array());
        let spread = (run.rate_square * share - square).max(T::ZERO) * T::from_f64(1.0 / 3.0);
        let rate = run.rate + mean_step * T::from_f64(0.01);
        let force = run.force + run.force_sum * share;
        let [x, y, z] = *force.as_array();
        let magnitude = x.hypot(y).hypot(z);
        // A bus that stalls delivers zeros, which stand still, too.
        if (magnitude - T::ONE).abs() > T::from_f64(Self::NO_GRAVITY) {
            return magnitude;
        }

        self.bias_variance += T::from_f64(Self::WANDER * Self::WANDER);
        // Who knows the zero well weighs a sway rightly; to who knows nothing of it, it would be the zero.
        let knows = self.bias_variance < T::from_f64(Self::UNKNOWN * Self::UNKNOWN);
        if knows || !sways(&rate, spread) {
            let floor = T::from_f64(Self::RATE_FLOOR * Self::RATE_FLOOR);
            let gain = self.bias_variance / (self.bias_variance + spread + floor);
            self.gyro_bias += (rate - self.gyro_bias) * gain;
            self.bias_variance *= T::ONE - gain;
        }

        let noise = T::from_f64(Self::FORCE_FLOOR * Self::FORCE_FLOOR);
        let gain = self.gravity_variance / (self.gravity_variance + noise);
        self.gravity += (magnitude - self.gravity) * gain;
        self.gravity_variance *= T::ONE - gain;
        let excess = (self.gravity - T::ONE) * T::from_f64(STANDARD_GRAVITY);
        self.accelerometer_bias = force * (excess / magnitude);
        magnitude
    }
}

/// Whether a standstill's mean rate (rad/s) may be a person's sway as well as a bias: it spreads, (0.01 rad/s)² an axis,
/// and by a good part of itself.
fn sways<T: Scalar>(rate: &SVector<T, 3>, spread: T) -> bool {
    let rate = rate * T::from_f64(100.0);
    let square = T::dot(rate.as_array(), rate.as_array());
    spread > T::from_f64(0.5 * 0.5) && spread > square * T::from_f64(0.2 * 0.2)
}

fn largest<T: Scalar>(vector: &SVector<T, 3>) -> T {
    vector.as_array().iter().fold(T::ZERO, |largest, component| largest.max(component.abs()))
}

#[cfg(test)]
mod tests;
