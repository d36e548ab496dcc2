use super::strapdown::Strapdown;
use super::{Navigator, Step, ZeroVelocity};
use crate::SensorClass;
use crate::sensor::Noise;
use kestirim_attitude::Orientation;
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// An error-state Kalman filter on zero velocities (Foxlin 2005; Skog et al. 2010).
///
/// Nine error states in earth axes: position (0–2, m), velocity (3–5, m/s), attitude (6–8, rad; the true
/// orientation is the estimate turned by it). A zero velocity is three scalar updates, so that nothing is
/// inverted. The covariances are kept 1000 times as large, which leaves every gain as it is and lets
/// fixed point resolve a milliradian's square.
///
/// The gyro bias is no state: standstills show it ([`Alignment`](crate::Alignment)), walking hardly does.
#[derive(Clone, Copy, Debug)]
pub struct Ekf<T: Scalar> {
    error: Gaussian<T, 9>,
    strapdown: Strapdown<T>,
    orientation: Orientation<T>,
    noise: Noise<T>,
    swing: T,
}

impl<T: Scalar> Ekf<T> {
    /// What all covariances are multiplied by.
    const SCALE: f64 = 1000.0;
    /// Standard deviation of the first tilt (rad).
    const TILT: f64 = 0.02;
    /// Standard deviation of a zero velocity at rest, sampled at [`Ekf::REFERENCE_INTERVAL`] (m/s).
    const ZERO_VELOCITY: f64 = 0.02;
    /// At another interval the variance changes in proportion, so that a second of stance weighs the same (s).
    const REFERENCE_INTERVAL: f64 = 0.005;
    /// The variance doubles at this unrest, (rad/s)².
    const UNREST: f64 = 0.3;
    /// The uncertainty grows no further in a longer swing (s): the next stance will be believed anyway.
    const LONGEST_SWING: f64 = 3.0;

    /// The covariance of the error, 9 × 9 in (m, m/s, rad)² × 1000.
    pub fn covariance(&self) -> &Covariance<T, 9> {
        &self.error.covariance
    }

    /// P through one step in which the force changed the velocity by `pushed` (m/s, earth).
    #[inline]
    fn propagate_covariance(&mut self, pushed: &SVector<T, 3>, dt: T) {
        let p = &mut self.error.covariance;
        p.shear::<0, 3>(dt);
        p.shear::<1, 4>(dt);
        p.shear::<2, 5>(dt);
        // δv ← δv + θ × u.
        let [x, y, z] = pushed.data.0[0];
        p.shear::<3, 7>(z);
        p.shear::<3, 8>(-y);
        p.shear::<4, 8>(x);
        p.shear::<4, 6>(-z);
        p.shear::<5, 6>(y);
        p.shear::<5, 7>(-x);

        let scaled = dt * T::from_f64(Self::SCALE);
        let velocity = self.noise.specific_force * self.noise.specific_force * scaled;
        p.add_variance::<3>(velocity);
        p.add_variance::<4>(velocity);
        p.add_variance::<5>(velocity);
        let attitude = self.noise.angular_rate * self.noise.angular_rate * scaled;
        p.add_variance::<6>(attitude);
        p.add_variance::<7>(attitude);
        p.add_variance::<8>(attitude);
    }

    /// Moves what the updates found of the error into the estimate.
    #[inline]
    fn inject(&mut self) {
        let [px, py, pz, vx, vy, vz, tx, ty, tz] = self.error.mean.data.0[0];
        self.strapdown.position += SVector::from([px, py, pz]);
        self.strapdown.velocity += SVector::from([vx, vy, vz]);
        self.orientation = self.orientation.turned_in_earth(&SVector::from([tx, ty, tz]));
        self.error.mean = SVector::zeros();
    }
}

impl<T: Scalar> Navigator<T> for Ekf<T> {
    fn start(sensor: SensorClass, orientation: Orientation<T>) -> Self {
        let tilt = T::from_f64(Self::TILT * Self::TILT * Self::SCALE);
        let zero = T::ZERO;
        let variances = [zero, zero, zero, zero, zero, zero, tilt, tilt, zero];
        Self {
            error: Gaussian::new(SVector::zeros(), Covariance::from_variances(&variances)),
            strapdown: Strapdown::at_rest(),
            orientation,
            noise: sensor.noise(),
            swing: T::ZERO,
        }
    }

    #[inline]
    fn propagate(&mut self, step: &Step<T>, _stance: bool) {
        let pushed = self.strapdown.integrate(&self.orientation, step);
        self.orientation = self.orientation.turned_in_body(&(step.angular_rate * step.interval));
        if self.swing < T::from_f64(Self::LONGEST_SWING) {
            self.swing += step.interval;
            self.propagate_covariance(&pushed, step.interval);
        }
    }

    #[inline]
    fn zero_velocity(&mut self, zero: &ZeroVelocity<T>) {
        let base = T::from_f64(
            Self::ZERO_VELOCITY * Self::ZERO_VELOCITY * Self::SCALE * Self::REFERENCE_INTERVAL,
        );
        let trust = T::ONE + zero.unrest * T::from_f64(1.0 / Self::UNREST);
        let variance = base * trust / zero.interval.max(T::from_f64(0.001));
        let [x, y, z] = (zero.velocity - self.strapdown.velocity).data.0[0];
        // An update is refused only where P has left the range of numbers; the others still hold.
        let _ = self.error.update_component::<3>(x, variance);
        let _ = self.error.update_component::<4>(y - self.error.mean.data.0[0][4], variance);
        let _ = self.error.update_component::<5>(z - self.error.mean.data.0[0][5], variance);
        self.inject();
        self.swing = T::ZERO;
    }

    /// Where the foot stood is where the next stride begins: its uncertainty is the caller's to add up, and
    /// the filter's numbers stay those of one stride, however long the walk.
    fn swing_begins(&mut self) {
        self.error.covariance.reset_component::<0>(T::ZERO);
        self.error.covariance.reset_component::<1>(T::ZERO);
        self.error.covariance.reset_component::<2>(T::ZERO);
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
