//! One opinion of where a robot on wheels is.

use super::drive::Drive;
use super::state::{BIAS, COSINE, COUNT, DRIFT, EXCESS, GAIN, SINE, X, Y};
use crate::wheel_noise::{
    DRIFT_SIGMA, GAIN_SIGMA, SLIP, TURN_TO_HEADING, UNKNOWN_SPEED, UNKNOWN_TIME, UNKNOWN_TURN,
    WAY_TO_HEADING,
};
use crate::{Error, OdometrySample};
use kestirim_kalman::{Covariance, Gaussian, Innovation};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// An estimate, the turns that the wheels have counted, and what the ranges say of it.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Course<T: Scalar> {
    pub(super) estimate: Gaussian<T, COUNT>,
    /// φ, rad, within ±π.
    turned: T,
    /// Sum of NIS + ln S of the ranges: −2 ln of how probable they are, but for a constant.
    pub(super) cost: T,
}

/// Variance of c and s before anything is known of the heading, for a scale of 1 or so.
const HEADING_VARIANCE: f64 = 0.5;
impl<T: Scalar> Course<T> {
    /// From a position (of a start in the plane: x, y and what is no state here), with a common bias and an
    /// excess in 10 m of these standard deviations (m) and turns of this sign.
    pub(super) fn begun<const N: usize>(
        start: &Gaussian<T, N>,
        [bias, excess]: [T; 2],
        gain: T,
    ) -> Self {
        let number = T::from_f64;
        let mut mean = SVector::<T, COUNT>::zeros();
        let [x, y] = [0, 1].map(|axis| start.mean.get(axis).copied().unwrap_or(T::ZERO));
        let known = mean.as_array_mut();
        (known[X], known[Y], known[GAIN]) = (x, y, gain);
        let known = |i, j| start.covariance.get(i, j).unwrap_or(T::ZERO);
        let mut matrix = SMatrix::<T, COUNT, COUNT>::zeros();
        let lower = matrix.as_columns_mut();
        (lower[X][X], lower[X][Y], lower[Y][Y]) = (known(0, 0), known(0, 1), known(1, 1));
        lower[COSINE][COSINE] = number(HEADING_VARIANCE);
        lower[SINE][SINE] = number(HEADING_VARIANCE);
        lower[DRIFT][DRIFT] = number(DRIFT_SIGMA * DRIFT_SIGMA);
        lower[GAIN][GAIN] = number(GAIN_SIGMA * GAIN_SIGMA);
        lower[BIAS][BIAS] = bias * bias;
        lower[EXCESS][EXCESS] = excess * excess;
        let covariance = Covariance::from_lower_triangle(&matrix);
        Self { estimate: Gaussian::new(mean, covariance), turned: T::ZERO, cost: T::ZERO }
    }

    /// Drives on for `interval` (s) without wheels, somehow, but no faster than at their last `speed` (m/s).
    ///
    /// # Errors
    /// [`Error::Estimate`].
    #[inline(never)] // Rare.
    pub(super) fn drift(&mut self, interval: T, speed: T) -> Result<(), Error> {
        let number = T::from_f64;
        let square = (speed * speed).max(number(UNKNOWN_SPEED * UNKNOWN_SPEED));
        let position_noise = interval * square * number(UNKNOWN_TIME);
        let heading_noise = interval * number(UNKNOWN_TURN);
        let (way, turn) = ([T::ZERO; 2], T::ZERO);
        Ok(self.estimate.advance(&Drive { interval, way, turn, position_noise, heading_noise })?)
    }

    /// Drives on for `interval` (s) as the wheels say. What they are doubted by multiplies their noise.
    ///
    /// # Errors
    /// [`Error::Estimate`].
    #[inline]
    pub(super) fn drive(
        &mut self,
        interval: T,
        wheels: &OdometrySample<T>,
        doubt: T,
    ) -> Result<(), Error> {
        let number = T::from_f64;
        let mean = self.estimate.mean.as_array();
        let (way, turn) = (wheels.speed * interval, wheels.turn_rate * interval);
        let turns = mean[GAIN] * turn + mean[DRIFT] * interval * number(0.01);
        let (sine, cosine) = (self.turned + turns * T::HALF).sin_cos();
        let (length, angle) = (way.abs() * doubt, turn.abs() * doubt);
        self.estimate.advance(&Drive {
            interval,
            way: [way * cosine, way * sine],
            turn,
            position_noise: length * number(SLIP),
            heading_noise: length * number(WAY_TO_HEADING) + angle * number(TURN_TO_HEADING),
        })?;
        self.turned = wrapped(self.turned + turns);
        Ok(())
    }

    /// Adds what a range says of the course.
    #[inline]
    pub(super) fn charge(&mut self, seen: &Innovation<T>, most: T) {
        self.cost += seen.nis.min(most) + seen.variance.ln();
    }
}

/// An angle within ±π.
#[inline]
fn wrapped<T: Scalar>(angle: T) -> T {
    let turn = T::TWO * T::PI;
    if angle.abs() <= T::PI {
        angle
    } else if angle.abs() < turn {
        if angle > T::ZERO { angle - turn } else { angle + turn }
    } else {
        let (sine, cosine) = angle.sin_cos();
        sine.atan2(cosine)
    }
}
