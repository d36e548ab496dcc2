use crate::Error;
use crate::matrix::{identity, times};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// What three axes of a sensor measure wrong: corrected = matrix · (measured − offset).
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
pub struct Triad<T: Scalar> {
    /// What the sensor shows where there is nothing to measure, in its unit.
    pub offset: SVector<T, 3>,
    /// Scale factors on the diagonal, misalignments (rad, for small ones) beside it; without a unit.
    pub matrix: SMatrix<T, 3, 3>,
}

impl<T: Scalar> Triad<T> {
    /// The triad of a perfect sensor.
    pub fn identity() -> Self {
        Self { offset: SVector::zeros(), matrix: SMatrix::from(identity()) }
    }

    /// What the sensor should have measured, in the unit of `measured`.
    #[inline]
    pub fn apply(&self, measured: &SVector<T, 3>) -> SVector<T, 3> {
        let ([x, y, z], [ox, oy, oz]) = (*measured.as_array(), *self.offset.as_array());
        SVector::from(times(self.matrix.as_columns(), &[x - ox, y - oy, z - oz]))
    }

    /// Refuses what is not finite.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let finite = T::all_finite(self.offset.as_array())
            && T::all_finite(self.matrix.as_columns().as_flattened());
        if finite { Ok(()) } else { Err(Error::NotFinite) }
    }
}

impl<T: Scalar> Default for Triad<T> {
    fn default() -> Self {
        Self::identity()
    }
}

/// What an inertial sensor measures wrong.
///
/// The corrected frame is the accelerometer's: its x axis is x, its y axis lies in the plane of x and y (Tedaldi
/// et al. 2014). The gyroscope's axes are turned into it.
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
pub struct Calibration<T: Scalar> {
    /// The accelerometer's offset (m/s²) and matrix (upper triangular).
    pub accelerometer: Triad<T>,
    /// The gyroscope's bias (rad/s) and matrix.
    pub gyroscope: Triad<T>,
}

impl<T: Scalar> Calibration<T> {
    /// That of a perfect sensor.
    pub fn identity() -> Self {
        Self { accelerometer: Triad::identity(), gyroscope: Triad::identity() }
    }

    /// The specific force (m/s²) and the angular rate (rad/s) that the sensor should have measured, both in its
    /// frame.
    #[inline]
    pub fn apply(
        &self,
        specific_force: &SVector<T, 3>,
        angular_rate: &SVector<T, 3>,
    ) -> (SVector<T, 3>, SVector<T, 3>) {
        (self.accelerometer.apply(specific_force), self.gyroscope.apply(angular_rate))
    }
}

impl<T: Scalar> Default for Calibration<T> {
    fn default() -> Self {
        Self::identity()
    }
}
