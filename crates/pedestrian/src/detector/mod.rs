//! Detectors of stance behind one trait, each O(1) a sample in fixed memory.

mod adaptive;
mod shoe;
mod simple;
mod swing_level;
mod window;

pub use adaptive::Adaptive;
pub(crate) use adaptive::RecentMinimum;
pub use shoe::{FixedShoe, Shoe};
pub use simple::{AngularRateEnergy, Magnitude, MovingVariance};
pub(crate) use swing_level::SwingLevel;

use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// Input of a detector: a sample without its biases, in units in which everyday values are about one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<T: Scalar> {
    /// Time (µs; wraps every 71 minutes).
    pub time_us: u32,
    /// Specific force without its bias, in units of standard gravity (body).
    pub force_g: SVector<T, 3>,
    /// Angular rate (rad/s, body).
    pub angular_rate: SVector<T, 3>,
}

/// Decision of a detector about the newest sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Verdict<T> {
    /// The foot stands.
    pub stance: bool,
    /// The SHOE statistic T, (rad/s)²: small for a foot at rest; 0 from a detector without a statistic.
    /// A zero-velocity update weighs the more the smaller it is.
    pub statistic: T,
}

/// Tells stance from swing, causally.
pub trait StanceDetector<T: Scalar> {
    /// Takes the next sample, whose time is not before the last one's.
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T>;
}
