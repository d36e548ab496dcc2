use crate::matrix::{Square, identity, product, rotation, times};
use crate::{Error, Triad};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// A turn from one pose to the next, as the gyroscope measured it.
///
/// It holds the turn itself and its sensitivity to the nine entries of the gyroscope's matrix, so that no sample is
/// kept.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Turn<T: Scalar> {
    assumed: Triad<T>,
    /// The columns of the rotation from the sensor's current frame to its frame at the beginning.
    attitude: Square<T>,
    /// ∫ R(t) e ω dt by the component of ω and the axis e: the effect of an entry of the matrix on the turn (rad, frame
    /// at the beginning).
    sensitivity: [Square<T>; 3],
}

impl<T: Scalar> Turn<T> {
    /// The longest interval of a sample, s: in a longer one the sensor's motion is unknown.
    const LONGEST: f64 = 0.5;

    /// Begins at rest, with what is known of the gyroscope: at first only its bias.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(assumed: Triad<T>) -> Result<Self, Error> {
        assumed.check()?;
        Ok(Self { assumed, attitude: identity(), sensitivity: [[[T::ZERO; 3]; 3]; 3] })
    }

    /// Integrates a sample: the measured angular rate (rad/s, sensor), held for `interval` seconds.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::Inconsistent`] for an interval that is negative or longer than half a second;
    /// nothing is changed.
    pub fn push(&mut self, angular_rate: &SVector<T, 3>, interval: T) -> Result<(), Error> {
        if !interval.is_finite() {
            return Err(Error::NotFinite);
        }
        if interval < T::ZERO || interval > T::from_f64(Self::LONGEST) {
            return Err(Error::Inconsistent);
        }
        let rate = self.assumed.apply(angular_rate);
        let turned = rate.as_array().map(|rate| rate * interval);
        let half = rotation(turned.map(|angle| angle * T::HALF));
        let middle = product(&self.attitude, &half);
        let mut next = *self;
        for (by_row, turned) in next.sensitivity.iter_mut().zip(turned) {
            for (sum, axis) in by_row.iter_mut().zip(&middle) {
                for (sum, &axis) in sum.iter_mut().zip(axis) {
                    *sum += axis * turned;
                }
            }
        }
        next.attitude = product(&middle, &half);
        let finite = T::all_finite(next.attitude.as_flattened())
            && T::all_finite(next.sensitivity.as_flattened().as_flattened());
        if !finite {
            return Err(Error::NotFinite);
        }
        *self = next;
        Ok(())
    }

    /// Converts a direction from the sensor's current frame to its frame at the beginning.
    pub fn to_beginning(&self, direction: &SVector<T, 3>) -> SVector<T, 3> {
        SVector::from(times(&self.attitude, direction.as_array()))
    }

    /// The effect of each entry of the matrix on the turn, by column and row.
    pub(crate) fn sensitivity(&self) -> &[Square<T>; 3] {
        &self.sensitivity
    }
}
