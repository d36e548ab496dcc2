use crate::{Gaussian, Process};
use kestirim_scalar::{Components, Scalar};

/// Constant-velocity motion driven by white acceleration, in D dimensions.
///
/// The first D states are the position (m), the next D the velocity (m/s); further states are left as
/// they are. x ← x + g v + ½ a h², v ← d v + a h over h seconds, where a is a known acceleration.
/// Without decay g = h and d = 1, and Q is that of continuous white noise,
/// q·\[h³/3, h²/2; h²/2, h\] per axis (Bar-Shalom, Li and Kirubarajan 2001, 6.2.2). With a decay time τ
/// the velocity is forgotten, v̇ = −v/τ + w, in steps of any length without an exponential:
/// d = 1/(1 + h/τ), g = h d. Its variance settles at q τ/2, as the exact one does, so a tag that is no
/// longer heard drifts but does not run away.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ConstantVelocity<T, const D: usize> {
    /// h, the length of the step, s: not negative.
    pub interval: T,
    /// q, the power spectral density of the acceleration, m²/s³: not negative.
    pub acceleration_density: T,
    /// τ, the time constant with which the velocity decays, s; `None` for no decay.
    pub decay_time: Option<T>,
    /// a, the measured acceleration, m/s²; `None` if unknown.
    pub acceleration: Option<[T; D]>,
}

impl<T: Scalar, const D: usize> ConstantVelocity<T, D> {
    /// Motion over `interval` (s) with white acceleration of this density (m²/s³).
    pub const fn new(interval: T, acceleration_density: T) -> Self {
        Self { interval, acceleration_density, decay_time: None, acceleration: None }
    }

    /// (g, d, Q), with Q of one axis as variance of position, covariance, variance of velocity.
    #[inline]
    fn coefficients(&self) -> (T, T, [T; 3]) {
        let (h, q) = (self.interval, self.acceleration_density);
        let third = T::from_f64(1.0 / 3.0);
        // Fixed point would leave its rail in a product with a number below one: such factors come first.
        let Some(tau) = self.decay_time else {
            // On a rail, the variance of the velocity shows it.
            let gained = q * h;
            return (h, T::ONE, [gained * third * h * h, gained * T::HALF * h, gained]);
        };
        let divisor = (tau + h).divisor();
        let decay = tau.divided_by(divisor);
        let reach = h * decay;
        // Both tend to those of white noise for h ≪ τ and to those of the settled process for h ≫ τ.
        let velocity = q * T::HALF * reach * (T::ONE + decay);
        let position = q * third * reach * reach * h * (T::ONE + T::TWO * h.divided_by(divisor));
        (reach, decay, [position, velocity * T::HALF * reach, velocity])
    }
}

impl<T: Scalar, const D: usize, const N: usize> Process<T, N> for ConstantVelocity<T, D> {
    #[inline]
    fn advance(&self, estimate: &mut Gaussian<T, N>) {
        const { assert!(2 * D <= N, "each coordinate has a position and a velocity") };
        let (reach, decay, [position, cross, velocity]) = self.coefficients();
        let mean = estimate.mean.as_array_mut();
        for axis in 0..D {
            mean[axis] = moved(mean[axis], reach * mean[D + axis]);
            mean[D + axis] *= decay;
            if let Some(acceleration) = &self.acceleration {
                let gained = self.interval * acceleration[axis];
                mean[axis] = moved(mean[axis], gained * T::HALF * self.interval);
                mean[D + axis] = moved(mean[D + axis], gained);
            }
        }
        let covariance = &mut estimate.covariance;
        for axis in 0..D {
            covariance.shear_at(axis, D + axis, reach);
            if self.decay_time.is_some() {
                covariance.scale_component(D + axis, decay);
                *covariance.entry(D + axis, D + axis) *= decay;
            }
            *covariance.entry(axis, axis) += position;
            *covariance.entry(axis, D + axis) += cross;
            *covariance.entry(D + axis, D + axis) += velocity;
        }
    }
}

/// The sum of a state and its change; what is on a rail of fixed point stays there.
#[inline(always)]
fn moved<T: Scalar>(state: T, change: T) -> T {
    if T::IS_FLOAT || state.is_finite() && change.is_finite() {
        state + change
    } else if state.is_finite() {
        change
    } else {
        state
    }
}
