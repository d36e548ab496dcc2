//! Navigation from specific force and angular rate to position, aided by the foot's own standstills.

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

/// A time step with the motion of the foot in it.
#[derive(Clone, Copy, Debug)]
pub struct Step<T: Scalar> {
    /// The interval of the step (s).
    pub interval: T,
    /// The specific force without its bias (units of standard gravity, body), held over the step.
    pub force_g: SVector<T, 3>,
    /// The angular rate without its bias (rad/s, body), held over the step.
    pub angular_rate: SVector<T, 3>,
    /// The turn of the body in the step (rad): rate times interval, and in swing the coning correction.
    pub turn: SVector<T, 3>,
}

/// A zero-velocity measurement: the foot stands, so its velocity is known.
#[derive(Clone, Copy, Debug)]
pub struct ZeroVelocity<T: Scalar> {
    /// The sensor's velocity (m/s, earth): zero, or that of a foot that rolls on the ground.
    pub velocity: SVector<T, 3>,
    /// The SHOE statistic T of the detector's verdict, (rad/s)².
    pub statistic: T,
    /// The duration of the step that ends in this sample (s).
    pub interval: T,
    /// Whether this is the first of its stance, in which a swing ends.
    pub landing: bool,
}

/// Navigates a foot by dead reckoning and zero velocities.
///
/// Steps are checked beforehand: finite, bounded, of positive length.
pub trait Navigator<T: Scalar> {
    /// Creates a navigator at the origin, at rest.
    fn start(sensor: SensorClass, orientation: Orientation<T>) -> Self;
    /// Advances by one step.
    fn propagate(&mut self, step: &Step<T>, stance: bool);
    /// Applies a turn that the gyroscope missed at the end of its range.
    fn miss(&mut self, missed: &MissedTurn<T>);
    /// Applies a zero velocity at the end of this step.
    fn zero_velocity(&mut self, zero: &ZeroVelocity<T>);
    /// Restarts at rest with this orientation after the tilt was lost, at the position that the swing led to, without
    /// the drift of its velocity.
    fn restart(&mut self, sensor: SensorClass, orientation: Orientation<T>);
    /// The position of the sensor (m, earth, from the start).
    fn position(&self) -> SVector<T, 3>;
    /// The velocity of the sensor (m/s, earth).
    fn velocity(&self) -> SVector<T, 3>;
    /// The orientation of the sensor, body → earth.
    fn orientation(&self) -> Orientation<T>;
}
