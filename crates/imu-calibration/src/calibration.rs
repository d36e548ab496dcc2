use crate::Error;
use crate::matrix::{identity, times};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The correction of a three-axis sensor: corrected = matrix · (measured − offset).
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
    /// The reading of the sensor for zero input, in its unit.
    pub offset: SVector<T, 3>,
    /// Scale factors on the diagonal, misalignments (rad, for small ones) off it; dimensionless.
    pub matrix: SMatrix<T, 3, 3>,
}

impl<T: Scalar> Triad<T> {
    /// The correction of a perfect sensor.
    pub fn identity() -> Self {
        Self { offset: SVector::zeros(), matrix: SMatrix::from(identity()) }
    }

    /// Corrects a measurement, in the unit of `measured`.
    #[inline]
    pub fn apply(&self, measured: &SVector<T, 3>) -> SVector<T, 3> {
        let ([x, y, z], [ox, oy, oz]) = (*measured.as_array(), *self.offset.as_array());
        SVector::from(times(self.matrix.as_columns(), &[x - ox, y - oy, z - oz]))
    }

    /// Rejects a triad that is not finite.
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

/// The calibration of an inertial sensor.
///
/// The corrected frame is that of the accelerometer: its x axis is the sensor's, its y axis lies in the plane of the
/// sensor's x and y (Tedaldi et al. 2014). The gyroscope's axes are rotated into it.
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
    /// The calibration of a perfect sensor.
    pub fn identity() -> Self {
        Self { accelerometer: Triad::identity(), gyroscope: Triad::identity() }
    }

    /// Corrects a specific force (m/s²) and an angular rate (rad/s), both in the sensor's frame.
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
