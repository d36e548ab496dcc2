use crate::ImuSample;
use crate::sensor::{Prior, SensorClass};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Standard gravity (m/s²).
pub(crate) const STANDARD_GRAVITY: f64 = 9.80665;

/// The gyro bias and the observable part of an accelerometer bias, learnt at standstill.
///
/// The stream is cut into eighths of a second. Four in a row whose mean rates and forces agree are a standstill of half
/// a second; a stance in walking is shorter. It is weighted by its own spread against what the class of the sensor
/// promises: people sway, and a good gyroscope knows its zero better than a swaying foot shows it, whereas that of a
/// bare chip may be off by a hundred times as much.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Alignment<T: Scalar> {
    gyro_bias: SVector<T, 3>,
    /// The variance of the bias of each axis, (0.01 rad/s)²: one number, since sway turns about every axis. (In this
    /// unit Q12.20 holds the squares of both the largest bias and the smallest noise.)
    bias_variance: T,
    /// The accelerometer's magnitude at rest, in units of standard gravity.
    gravity: T,
    gravity_variance: T,
    /// The accelerometer bias (m/s², body).
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
    /// The sum of the rates (rad/s).
    rate: SVector<T, 3>,
    /// The sum of the forces (m/s²).
    force: SVector<T, 3>,
}

/// Deviations of a run of blocks from the first of them.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Standstill<T: Scalar> {
    blocks: i32,
    rate: SVector<T, 3>,
    force: SVector<T, 3>,
    /// The sum of the rate deviations (0.01 rad/s).
    rate_sum: SVector<T, 3>,
    /// The sum of the squared rate deviations, (0.01 rad/s)².
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
    /// The largest number of samples that are added up: fixed point has room for the sum of so many forces of 10 m/s².
    const MOST_SAMPLES: i32 = 200;
    /// The largest difference of rates between the blocks of a standstill (rad/s).
    const RATE_SPREAD: f64 = 0.03;
    /// The largest rate that a bias explains (rad/s): a larger one is no standstill, however steady.
    const LARGEST_BIAS: f64 = 0.35;
    /// The largest difference of forces between the blocks of a standstill (g).
    const FORCE_SPREAD: f64 = 0.04;
    /// The gyroscope's own noise over a standstill (0.01 rad/s): the lower limit of the spread.
    const RATE_FLOOR: f64 = 0.07;
    /// The largest deviation from gravity (g) of an accelerometer at rest: nothing is learnt beyond it.
    const NO_GRAVITY: f64 = 0.5;
    /// The accelerometer's own noise over a standstill, relative to g.
    const FORCE_FLOOR: f64 = 0.001;
    /// A bias with a larger standard deviation than this is unknown (0.01 rad/s).
    const UNKNOWN: f64 = 1.0;
    /// The standard deviation of a bias's random walk between two standstills (0.01 rad/s).
    const WANDER: f64 = 0.01;

    /// The prior state for the class of the sensor.
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

    /// The smallest accelerometer bias that explains the reading at rest (m/s², body): it lies along gravity. Across
    /// gravity a bias cannot be distinguished from a tilt.
    pub fn accelerometer_bias(&self) -> &SVector<T, 3> {
        &self.accelerometer_bias
    }

    /// The relative error of gravity at rest combined with its standard deviation, which is that of the class if
    /// gravity was never seen.
    pub(crate) fn gravity_off(&self) -> T {
        (self.gravity - T::ONE).hypot(self.gravity_variance.sqrt())
    }

    /// Whether the gyro bias is known: from a standstill, or by the class of the sensor.
    pub(crate) fn knows_bias(&self) -> bool {
        self.bias_variance < T::from_f64(Self::UNKNOWN * Self::UNKNOWN)
    }

    /// Keeps what was learnt and forgets the stream, to restart it.
    pub(crate) fn rewound(mut self) -> Self {
        self.block = Block::new();
        self.standstill.blocks = 0;
        self
    }

    /// Processes the next sample; returns `Some(|f|/g₀)` when a standstill has just refined the estimates.
    pub(crate) fn update(&mut self, sample: &ImuSample<T>) -> Option<T> {
        // The lower 32 bits are enough for differences.
        let time_us = sample.time_us as u32;
        let begun_us = *self.block.begun_us.get_or_insert(time_us);
        // Of a fast sensor the first are enough.
        if self.block.count < Self::MOST_SAMPLES {
            self.block.rate += sample.angular_rate;
            self.block.force += sample.specific_force;
            self.block.count += 1;
        }
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

    /// Updates bias and gravity by one scalar update each from a whole standstill; returns |f|/g₀.
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
        // A stalled bus delivers zeros, which look like a standstill, too.
        if (magnitude - T::ONE).abs() > T::from_f64(Self::NO_GRAVITY) {
            return magnitude;
        }

        self.bias_variance += T::from_f64(Self::WANDER * Self::WANDER);
        // With a well-known zero a sway is weighted correctly; with an unknown one it would become the zero.
        if self.knows_bias() || !sways(&rate, spread) {
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

/// Whether a standstill's mean rate (rad/s) may be a person's sway as well as a bias: its `spread`, (0.01 rad/s)² per
/// axis, is large, also relative to the rate itself.
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
