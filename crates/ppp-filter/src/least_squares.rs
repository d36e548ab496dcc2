//! Least squares for three coordinates and a clock, from range differences along lines of sight.

use kestirim_kalman::{Covariance, Error, Gaussian, SparseRow};
use kestirim_scalar::Components;
use nalgebra::{SVector, Vector3};

/// The corrections to a receiver's assumed position and clock, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step(Gaussian<f64, 4>);

impl Step {
    /// An unknown step with a prior variance of each component, m².
    #[inline(never)] // Wanted at two places, once in flash.
    pub(crate) fn unknown(variance: f64) -> Self {
        Self(Gaussian::new(SVector::zeros(), Covariance::from_variances(&[variance; 4])))
    }

    /// Adds a range along a line of sight, which is longer than assumed by `difference`, m.
    ///
    /// Returns the squared innovation in its variance: the sum of these is that of all residuals.
    #[inline(never)] // Wanted at two places, once in flash.
    pub(crate) fn take_in(
        &mut self,
        sight: &Vector3<f64>,
        difference: f64,
        variance: f64,
    ) -> Result<f64, Error> {
        let [x, y, z, clock] = *self.0.mean.as_array();
        let expected = clock - sight.dot(&Vector3::new(x, y, z));
        let row = SparseRow::new([(0, -sight.x), (1, -sight.y), (2, -sight.z), (3, 1.0)]);
        let taken = self.0.update(&row, difference - expected, variance)?;
        Ok(taken.nis)
    }

    pub(crate) fn coordinates(&self) -> Vector3<f64> {
        self.0.mean.xyz()
    }

    pub(crate) fn clock(&self) -> f64 {
        self.0.mean.w
    }

    /// The norm of all four components, m.
    pub(crate) fn length(&self) -> f64 {
        self.0.mean.norm()
    }

    /// The largest variance of the four components, m².
    pub(crate) fn spread(&self) -> f64 {
        self.0.covariance.variances().max()
    }
}
