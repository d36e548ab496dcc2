//! The attitude reference alone, as a workload for the replay: the basic cost of the inertial sensor of a foot, a drone
//! or a robot.

use kestirim_attitude::{Ahrs, Gains, Orientation};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;
use support::Class;

use crate::four_ranges::Named;
use crate::replay::Tracker;
use crate::stream::Sample;

/// A reference that starts upright and without a known gyroscope bias.
pub struct Reference<T: Scalar> {
    ahrs: Ahrs<T>,
    last_us: u64,
}

/// A sample in the reference's own scalar.
pub struct Input<T: Scalar> {
    time_us: u64,
    specific_force: SVector<T, 3>,
    angular_rate: SVector<T, 3>,
}

impl<T: Scalar> Default for Reference<T> {
    fn default() -> Self {
        let ahrs = Ahrs::new(Orientation::identity(), SVector::zeros(), Gains::default());
        Self { ahrs, last_us: 0 }
    }
}

impl<T: Named> Tracker for Reference<T> {
    const NAME: &str = "ahrs";
    const SCALAR: &str = T::NAME;
    type Record = Sample;
    type Input = Input<T>;

    fn input(sample: &Sample) -> Input<T> {
        Input {
            time_us: sample.time_us,
            specific_force: SVector::from(sample.specific_force.map(T::from_f32)),
            angular_rate: SVector::from(sample.angular_rate.map(T::from_f32)),
        }
    }

    #[inline(always)]
    fn step(&mut self, sample: &Input<T>) -> Class {
        let elapsed_us = sample.time_us.saturating_sub(self.last_us);
        self.last_us = sample.time_us;
        let interval = T::from_micro(i32::try_from(elapsed_us).unwrap_or(i32::MAX));
        match self.ahrs.update(&sample.angular_rate, Some(&sample.specific_force), interval) {
            Ok(()) => Class::Update,
            Err(_) => Class::Rejected,
        }
    }

    /// The upward direction in the body axes, instead of a position.
    fn position(&self) -> [f32; 3] {
        self.ahrs.orientation().up_in_body().as_array().map(T::to_f32)
    }
}
