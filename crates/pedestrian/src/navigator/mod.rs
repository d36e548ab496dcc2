//! From specific force and angular rate to position, held by the foot's own standstills.

mod ekf;
mod lite;
mod strapdown;

pub use ekf::Ekf;
pub use lite::Lite;
pub(crate) use strapdown::{coning, velocity_of_rolling};

use crate::{MissedTurn, SensorClass};
use kestirim_attitude::Orientation;
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// One step of time with what moved the foot in it.
#[derive(Clone, Copy, Debug)]
pub struct Step<T: Scalar> {
    /// Interval of the step (s).
    pub interval: T,
    /// Specific force without its bias (units of standard gravity, body), held over the step.
    pub force_g: SVector<T, 3>,
    /// Angular rate without its bias (rad/s, body), held over the step.
    pub angular_rate: SVector<T, 3>,
    /// How the body turns in the step (rad): their product, and in swing what coning adds.
    pub turn: SVector<T, 3>,
}

/// The foot is known to stand: its velocity is known.
#[derive(Clone, Copy, Debug)]
pub struct ZeroVelocity<T: Scalar> {
    /// The sensor's velocity (m/s, earth): zero, or that of a foot which rolls on the ground.
    pub velocity: SVector<T, 3>,
    /// The SHOE statistic T of the detector's verdict, (rad/s)².
    pub statistic: T,
    /// The step that ends in this sample (s).
    pub interval: T,
    /// The first of its stance: a swing ends.
    pub landing: bool,
}

/// Navigates a foot by dead reckoning and zero velocities.
///
/// Steps are checked before they come here: finite, bounded, of positive length.
pub trait Navigator<T: Scalar> {
    /// A navigator at the origin, at rest.
    fn start(sensor: SensorClass, orientation: Orientation<T>) -> Self;
    /// Moves by one step.
    fn propagate(&mut self, step: &Step<T>, stance: bool);
    /// The gyroscope was at the end of its range: the body has turned by more than it measured.
    fn miss(&mut self, missed: &MissedTurn<T>);
    /// The foot stands at the end of this step.
    fn zero_velocity(&mut self, zero: &ZeroVelocity<T>);
    /// The tilt was lost: begins anew at rest with this orientation, where the swing led with the drift of its velocity
    /// taken back.
    fn restart(&mut self, sensor: SensorClass, orientation: Orientation<T>);
    /// Position of the sensor (m, earth, from the start).
    fn position(&self) -> SVector<T, 3>;
    /// Velocity of the sensor (m/s, earth).
    fn velocity(&self) -> SVector<T, 3>;
    /// Orientation of the sensor, body → earth.
    fn orientation(&self) -> Orientation<T>;
}
