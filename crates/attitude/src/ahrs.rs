use crate::Orientation;
use core::fmt;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Reason why an [`Ahrs`] refused a sample. Its state is as it was before the call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// A component of the angular rate, the specific force or the interval is not finite.
    NotFinite,
    /// The interval is negative.
    NegativeInterval,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a component of the sample is not finite",
            Self::NegativeInterval => "the interval is negative",
        })
    }
}

impl core::error::Error for Error {}

/// Gains with which gravity corrects the integrated gyroscope.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gains<T> {
    /// Tilt correction (1/s): 1/gain is the time constant with which gravity corrects the gyroscope.
    pub tilt: T,
    /// Gyro bias correction (1/s²), the integral term; zero keeps the initial bias.
    pub bias: T,
    /// Largest deviation of |f|/g from 1 at which the specific force is taken for gravity.
    pub gate: T,
}

impl<T: Scalar> Default for Gains<T> {
    /// Time constants of 1 s for the tilt and half a minute for the bias, and a gate of ±10 % of g.
    fn default() -> Self {
        Self { tilt: T::ONE, bias: T::from_f64(0.03), gate: T::from_f64(0.1) }
    }
}

/// An attitude and heading reference: gyroscope and accelerometer fused in a quaternion.
///
/// The explicit complementary filter of Mahony, Hamel & Pflimlin (IEEE TAC 2008, eq. 48), whose
/// tilt error is e = f̂ × ĝ in body axes: the angular rate is corrected by `tilt·e`, the gyro bias by
/// `−bias·e`. The accelerometer is used only while its magnitude is near g; the heading comes from the
/// gyroscope alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Ahrs<T: Scalar> {
    orientation: Orientation<T>,
    gyro_bias: SVector<T, 3>,
    gains: Gains<T>,
}

impl<T: Scalar> Ahrs<T> {
    /// Standard gravity (m/s²).
    const GRAVITY: f64 = 9.80665;

    /// A reference that starts at `orientation` with a known or zero gyro bias (rad/s, body).
    pub fn new(orientation: Orientation<T>, gyro_bias: SVector<T, 3>, gains: Gains<T>) -> Self {
        Self { orientation, gyro_bias, gains }
    }

    /// The rotation from body to earth after the last sample.
    pub fn orientation(&self) -> &Orientation<T> {
        &self.orientation
    }

    /// The estimated gyroscope bias, which is subtracted from its readings (rad/s, body).
    pub fn gyro_bias(&self) -> &SVector<T, 3> {
        &self.gyro_bias
    }

    /// Turns the reference by an external correction, given as a rotation vector in earth axes (rad).
    pub fn turn_in_earth(&mut self, correction: &SVector<T, 3>) {
        self.orientation = self.orientation.turned_in_earth(correction);
    }

    /// Turns the reference by a known turn of the body, given as a rotation vector in body axes (rad), where that is
    /// more accurate than rate × interval. The gyroscope's bias is not subtracted.
    pub fn turn_in_body(&mut self, turn: &SVector<T, 3>) {
        self.orientation = self.orientation.turned_in_body(turn);
    }

    /// Takes one sample: angular rate (rad/s) and specific force (m/s²), both in body axes, held for
    /// `interval` seconds. Without a force, or with one outside the gate, the gyroscope is
    /// integrated alone.
    ///
    /// # Errors
    /// [`Error`]; the state is untouched.
    pub fn update(
        &mut self,
        angular_rate: &SVector<T, 3>,
        specific_force: Option<&SVector<T, 3>>,
        interval: T,
    ) -> Result<(), Error> {
        if !interval.is_finite() {
            return Err(Error::NotFinite);
        }
        if interval < T::ZERO {
            return Err(Error::NegativeInterval);
        }
        let mut bias = self.gyro_bias;
        let mut rate = angular_rate - bias;
        let mut orientation = self.orientation;
        if let Some(force) = specific_force {
            orientation = orientation.renormalised();
            let error = self.tilt_error(force).ok_or(Error::NotFinite)?;
            let learnt = error * (self.gains.bias * interval);
            bias -= learnt;
            rate += learnt + error * self.gains.tilt;
        }
        let turn = rate * interval;
        if !turn.iter().copied().all(T::is_finite) {
            return Err(Error::NotFinite);
        }
        self.gyro_bias = bias;
        self.orientation = orientation.turned_in_body(&turn);
        Ok(())
    }

    /// f̂ × ĝ in body axes (rad for small tilts); zero if the force is outside the gate, `None` if it is
    /// not finite.
    fn tilt_error(&self, specific_force: &SVector<T, 3>) -> Option<SVector<T, 3>> {
        let force = specific_force * T::from_f64(1.0 / Self::GRAVITY);
        let [x, y, z] = *force.as_array();
        let square = T::dot(&[x, y, z], &[x, y, z]);
        if !square.is_finite() {
            return None;
        }
        // Compares squares to avoid the root: the magnitude is within the gate if its square is within these bounds.
        let (least, most) = (T::ONE - self.gains.gate, T::ONE + self.gains.gate);
        if square < least * least || square > most * most {
            return Some(SVector::zeros());
        }
        let [ux, uy, uz] = *self.orientation.up_in_body().as_array();
        Some(SVector::from([y * uz - z * uy, z * ux - x * uz, x * uy - y * ux]))
    }
}
