//! Stance detectors behind one trait, each O(1) per sample in fixed memory.

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

/// The input of a detector: a sample without its biases, in units in which ordinary values are about one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<T: Scalar> {
    /// The time (µs; wraps every 71 minutes).
    pub time_us: u32,
    /// The specific force without its bias, in units of standard gravity (body).
    pub force_g: SVector<T, 3>,
    /// The angular rate (rad/s, body).
    pub angular_rate: SVector<T, 3>,
}

/// The decision of a detector about the newest sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Verdict<T> {
    /// Whether the foot stands.
    pub stance: bool,
    /// The SHOE statistic T, (rad/s)²: small for a foot at rest; 0 from a detector without a statistic. The smaller it
    /// is, the more a zero-velocity update weighs.
    pub statistic: T,
}

/// A causal detector that distinguishes stance from swing.
pub trait StanceDetector<T: Scalar> {
    /// Processes the next sample, whose time must not precede that of the last one.
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T>;
}
