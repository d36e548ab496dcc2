//! When does the foot stand? Detectors behind one trait, each O(1) a sample in fixed memory.

mod adaptive;
mod shoe;
mod simple;
mod window;

pub use adaptive::Adaptive;
pub(crate) use adaptive::RecentMinimum;
pub use shoe::{FixedShoe, Shoe};
pub use simple::{AngularRateEnergy, Magnitude, MovingVariance};

use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// What a detector is shown: a sample whose biases are taken off, in units in which one is everyday.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<T: Scalar> {
    /// When (µs; wraps every 71 minutes).
    pub time_us: u32,
    /// Specific force without its bias, in units of standard gravity (body).
    pub force_g: SVector<T, 3>,
    /// Angular rate (rad/s, body).
    pub angular_rate: SVector<T, 3>,
}

/// What a detector says of the newest sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Verdict<T> {
    /// The foot stands.
    pub stance: bool,
    /// How still it is: the SHOE statistic T in (rad/s)², or 0 from a detector that knows only yes and no.
    /// A zero-velocity update trusts a still foot more.
    pub unrest: T,
}

/// Tells stance from swing, causally.
pub trait StanceDetector<T: Scalar> {
    /// Takes the next sample, whose time is not before the last one's.
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T>;
}
