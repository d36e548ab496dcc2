use super::strapdown::{Strapdown, cross};
use super::{Navigator, Step, ZeroVelocity};
use crate::sensor::Noise;
use crate::{MissedTurn, SensorClass};
use kestirim_attitude::Orientation;
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// An error-state Kalman filter with zero-velocity updates (Foxlin 2005; Skog et al. 2010).
///
/// Six error states in earth axes: velocity (0–2, m/s) and attitude (3–5, rad; the true orientation is the
/// estimate turned by it). A zero velocity is three scalar updates, so that nothing is inverted. The
/// covariances are kept 1000 times as large, which leaves every gain as it is and lets fixed point
/// resolve a milliradian's square.
///
/// Two quantities that other such filters estimate are no states here:
/// - **Position.** Whether a velocity error came from tilt (growing linearly) or from noise (a random walk), the
///   expected position error that it left is half of it times the swing's duration. The position is corrected by that,
///   which saves a third of the filter's work.
/// - **Gyro bias.** It is observable at standstill ([`Alignment`](crate::Alignment)), but hardly in walking.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ekf<T: Scalar> {
    error: Gaussian<T, 6>,
    strapdown: Strapdown<T>,
    orientation: Orientation<T>,
    noise: Noise<T>,
    /// The time since the last zero velocity (s).
    swing: T,
}

impl<T: Scalar> Ekf<T> {
    /// The scale of all covariances.
    const SCALE: f64 = 1000.0;
    /// The scale of all standard deviations.
    const ROOT_OF_SCALE: f64 = 31.622_776_6;
    /// The initial standard deviation of the tilt (rad).
    const TILT: f64 = 0.02;
    /// The standard deviation of a zero velocity at rest, sampled at [`Ekf::REFERENCE_INTERVAL`] (m/s).
    const ZERO_VELOCITY: f64 = 0.02;
    /// The reference interval (s): at another interval the variance changes in proportion, so that a second of stance
    /// weighs the same.
    const REFERENCE_INTERVAL: f64 = 0.005;
    /// The value of the SHOE statistic T at which the variance doubles, (rad/s)².
    const DOUBTFUL: f64 = 0.3;
    /// The standard deviation of a turn that the gyroscope missed, relative to its estimate.
    const MISSED: f64 = 0.5;
    /// The share of that uncertainty about the vertical: a foot that moves too fast for its gyroscope lands with
    /// velocities that have other causes, too, and would turn the heading.
    const MISSED_HEADING: f64 = 0.5;
    /// The longest swing in which the uncertainty grows (s): after it the next stance has full weight anyway.
    const LONGEST_SWING: f64 = 3.0;

    /// The variance up to which that of the heading grows in fixed point, (0.17 rad)² × 1000: standing does not observe it, and
    /// in the next swing it becomes a variance of the velocity, which must not saturate at 8 m/s.
    const MOST_HEADING: f64 = 30.0;

    /// The covariance of the error, 6 × 6 in (m/s, rad)² × 1000.
    pub fn covariance(&self) -> &Covariance<T, 6> {
        &self.error.covariance
    }

    /// Propagates P through one step in which the force changed the velocity by `pushed` (m/s, earth).
    #[inline]
    fn propagate_covariance(&mut self, pushed: &SVector<T, 3>, dt: T) {
        let p = &mut self.error.covariance;
        // δv ← δv + θ × u.
        let [x, y, z] = *pushed.as_array();
        p.shear::<0, 4>(z);
        p.shear::<0, 5>(-y);
        p.shear::<1, 5>(x);
        p.shear::<1, 3>(-z);
        p.shear::<2, 3>(y);
        p.shear::<2, 4>(-x);

        let attitude = self.noise.attitude_variance * dt;
        p.add_variance::<3>(attitude);
        p.add_variance::<4>(attitude);
        let most = T::from_f64(Self::MOST_HEADING);
        if T::IS_FLOAT || p.get(5, 5).is_some_and(|heading| heading < most) {
            p.add_variance::<5>(attitude);
        }
    }

    /// Moves the error that the updates found into the estimate.
    #[inline]
    fn inject(&mut self) {
        let [vx, vy, vz, tx, ty, tz] = *self.error.mean.as_array();
        let velocity = SVector::from([vx, vy, vz]);
        self.strapdown.position += velocity * (self.swing * T::HALF);
        self.strapdown.velocity += velocity;
        self.orientation = self.orientation.turned_in_earth(&SVector::from([tx, ty, tz]));
        self.error.mean = SVector::zeros();
    }
}

impl<T: Scalar> Navigator<T> for Ekf<T> {
    fn start(sensor: SensorClass, orientation: Orientation<T>) -> Self {
        let tilt = T::from_f64(Self::TILT * Self::TILT * Self::SCALE);
        let zero = T::ZERO;
        let variances = [zero, zero, zero, tilt, tilt, zero];
        Self {
            error: Gaussian::new(SVector::zeros(), Covariance::from_variances(&variances)),
            strapdown: Strapdown::at_rest(),
            orientation,
            noise: sensor.noise(Self::SCALE),
            swing: T::ZERO,
        }
    }

    #[inline]
    fn propagate(&mut self, step: &Step<T>, _stance: bool) {
        let pushed = self.strapdown.integrate(&self.orientation, step);
        self.orientation = self.orientation.turned_in_body(&step.turn);
        if self.swing < T::from_f64(Self::LONGEST_SWING) {
            self.swing += step.interval;
            self.propagate_covariance(&pushed, step.interval);
        }
    }

    #[cold]
    #[inline(never)]
    fn miss(&mut self, missed: &MissedTurn<T>) {
        let turn = self.orientation.to_earth(&missed.turn);
        let velocity = cross(&turn, &missed.pushed);
        self.orientation = self.orientation.turned_in_earth(&turn);
        self.strapdown.velocity += velocity;
        // All consequences of the turn are wrong by the same share as the turn itself.
        let ([x, y, z], [tx, ty, tz]) = (*velocity.as_array(), *turn.as_array());
        let doubtful = [x, y, z, tx, ty, tz * T::from_f64(Self::MISSED_HEADING)];
        let share = T::from_f64(Self::MISSED * Self::ROOT_OF_SCALE);
        self.error.covariance.add_outer(&SVector::from(doubtful.map(|entry| entry * share)));
    }

    #[inline]
    fn zero_velocity(&mut self, zero: &ZeroVelocity<T>) {
        // The velocity's random walk affects no other state: its growth since the last time is added now.
        let wandered = self.noise.velocity_variance * self.swing;
        self.error.covariance.add_variance::<0>(wandered);
        self.error.covariance.add_variance::<1>(wandered);
        self.error.covariance.add_variance::<2>(wandered);
        let base = T::from_f64(
            Self::ZERO_VELOCITY * Self::ZERO_VELOCITY * Self::SCALE * Self::REFERENCE_INTERVAL,
        );
        let trust = T::ONE + zero.statistic * T::from_f64(1.0 / Self::DOUBTFUL);
        let variance = base * trust / zero.interval.max(T::from_f64(0.001));
        let [x, y, z] = *(zero.velocity - self.strapdown.velocity).as_array();
        // An update is refused only where P has left the range of numbers; the other updates remain valid.
        let _ = self.error.update_component::<0>(x, variance);
        let _ = self.error.update_component::<1>(y - self.error.mean.as_array()[1], variance);
        let _ = self.error.update_component::<2>(z - self.error.mean.as_array()[2], variance);
        self.inject();
        self.swing = T::ZERO;
    }

    fn restart(&mut self, sensor: SensorClass, orientation: Orientation<T>) {
        let position = self.strapdown.position - self.strapdown.velocity * (self.swing * T::HALF);
        *self = Self::start(sensor, orientation);
        self.strapdown.position = position;
    }

    fn position(&self) -> SVector<T, 3> {
        self.strapdown.position
    }
    fn velocity(&self) -> SVector<T, 3> {
        self.strapdown.velocity
    }
    fn orientation(&self) -> Orientation<T> {
        self.orientation
    }
}

#[cfg(test)]
mod tests;
