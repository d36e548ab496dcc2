use super::strapdown::{Strapdown, cross};
use super::{Navigator, Step, ZeroVelocity};
use crate::alignment::STANDARD_GRAVITY;
use crate::{MissedTurn, SensorClass};
use kestirim_attitude::{Ahrs, Gains, Orientation};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The paper's own architecture: an attitude reference, integration, and removal of each stride's drift at its end.
///
/// A velocity error of e at the end of a swing of T seconds has grown linearly: the position is e·T/2 too far, and the
/// tilt was wrong by about e/(g·T). Both are corrected, the latter by half.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lite<T: Scalar> {
    ahrs: Ahrs<T>,
    strapdown: Strapdown<T>,
    /// The time of drift since the last zero velocity (s).
    drifted: T,
    until_gravity: u8,
}

impl<T: Scalar> Lite<T> {
    /// The share of the tilt that would explain a stride's drift by which the attitude is corrected.
    const TILT_SHARE: f64 = 0.5;
    /// The shortest time of drift (s) in which a velocity error shows the tilt: a shorter one counts as this long.
    const SHORTEST_SWING: f64 = 0.3;
    /// The reference uses gravity in one of this many stance samples, with as many times the gain.
    const GRAVITY_EVERY: u8 = 4;
    /// The longest drift that is assumed linear (s).
    const LONGEST_SWING: f64 = 10.0;
}

impl<T: Scalar> Navigator<T> for Lite<T> {
    fn start(_: SensorClass, orientation: Orientation<T>) -> Self {
        // In stance gravity corrects the tilt within a second; the bias is left to the alignment.
        let tilt = T::from_f64(f64::from(Self::GRAVITY_EVERY));
        let gains = Gains { tilt, bias: T::ZERO, gate: T::from_f64(0.2) };
        Self {
            ahrs: Ahrs::new(orientation, SVector::zeros(), gains),
            strapdown: Strapdown::at_rest(),
            drifted: T::ZERO,
            until_gravity: 1,
        }
    }

    #[inline]
    fn propagate(&mut self, step: &Step<T>, stance: bool) {
        self.strapdown.integrate(self.ahrs.orientation(), step);
        self.until_gravity =
            if stance { self.until_gravity.wrapping_sub(1) % Self::GRAVITY_EVERY } else { 1 };
        if self.until_gravity == 0 {
            let force = step.force_g * T::from_f64(STANDARD_GRAVITY);
            // Steps are checked: bounded rates over at most a fifth of a second.
            let _ = self.ahrs.update(&step.angular_rate, Some(&force), step.interval);
        } else {
            self.ahrs.turn_in_body(&step.turn);
        }
        self.drifted = (self.drifted + step.interval).min(T::from_f64(Self::LONGEST_SWING));
    }

    fn miss(&mut self, missed: &MissedTurn<T>) {
        let turn = self.ahrs.orientation().to_earth(&missed.turn);
        self.ahrs.turn_in_earth(&turn);
        self.strapdown.velocity += cross(&turn, &missed.pushed);
    }

    #[inline]
    fn zero_velocity(&mut self, zero: &ZeroVelocity<T>) {
        let error = self.strapdown.velocity - zero.velocity;
        self.strapdown.position -= error * (self.drifted * T::HALF);
        self.strapdown.velocity = zero.velocity;
        if zero.landing {
            let swing = self.drifted.max(T::from_f64(Self::SHORTEST_SWING));
            let share = T::from_f64(Self::TILT_SHARE / STANDARD_GRAVITY) / swing;
            let [x, y, _] = *error.as_array();
            self.ahrs.turn_in_earth(&SVector::from([y * share, -x * share, T::ZERO]));
        }
        self.drifted = T::ZERO;
    }

    fn restart(&mut self, sensor: SensorClass, orientation: Orientation<T>) {
        let position = self.strapdown.position - self.strapdown.velocity * (self.drifted * T::HALF);
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
        *self.ahrs.orientation()
    }
}

#[cfg(test)]
mod tests;
