//! The pedestrian trackers as workloads for the replay.

use kestirim_pedestrian::{
    Config, Ekf, Estimate, ImuSample, Lite, Navigator, Tracker as Pedestrian,
};
use kestirim_scalar::{Components, Q12_20, Scalar};
use nalgebra::SVector;
use support::Class;

use crate::replay::Tracker;
use crate::stream::Sample;

/// The names of a navigator and its scalar for tables.
pub trait Named {
    /// The name of the workload.
    const NAME: &str;
    /// The name of its scalar.
    const SCALAR: &str;
}

macro_rules! name {
    ($($navigator:ty: $name:literal $scalar:literal;)*) => {$(
        impl Named for $navigator {
            const NAME: &str = $name;
            const SCALAR: &str = $scalar;
        }
    )*};
}

name! {
    Lite<f32>: "pedestrian-lite" "f32";
    Lite<Q12_20>: "pedestrian-lite" "q12.20";
    Ekf<f32>: "pedestrian-ekf" "f32";
    Ekf<Q12_20>: "pedestrian-ekf" "q12.20";
}

/// A causal tracker with a consumer IMU and the adaptive detector.
pub struct Walk<T: Scalar, N> {
    tracker: Pedestrian<T, N>,
    position: SVector<T, 3>,
}

impl<T: Scalar, N: Navigator<T>> Default for Walk<T, N> {
    fn default() -> Self {
        Self { tracker: Pedestrian::new(Config::default()), position: SVector::zeros() }
    }
}

impl<T: Scalar, N: Navigator<T> + Named> Tracker for Walk<T, N> {
    const NAME: &str = N::NAME;
    const SCALAR: &str = N::SCALAR;
    type Record = Sample;
    type Input = ImuSample<T>;

    fn input(sample: &Sample) -> ImuSample<T> {
        ImuSample {
            time_us: sample.time_us,
            specific_force: SVector::from(sample.specific_force.map(T::from_f32)),
            angular_rate: SVector::from(sample.angular_rate.map(T::from_f32)),
        }
    }

    #[inline(always)]
    fn step(&mut self, sample: &ImuSample<T>) -> Class {
        match self.tracker.update(sample) {
            Ok(Estimate { position, stance, .. }) => {
                self.position = position;
                if stance { Class::Update } else { Class::Predict }
            }
            Err(_) => Class::Rejected,
        }
    }

    fn position(&self) -> [f32; 3] {
        self.position.as_array().map(T::to_f32)
    }
}
