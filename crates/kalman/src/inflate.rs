//! Doubt in one state of many.

use crate::{Covariance, Error};
use kestirim_scalar::Scalar;

impl<T: Scalar, const N: usize> Covariance<T, N> {
    /// P ← D P D with D = diag(1, …, √`factor`, …, 1): the variance of a state times `factor`, its
    /// correlations as they were.
    ///
    /// So P stays positive, whatever the factor; its rounding is left to the next update, as that of a
    /// [`Covariance::shear`] is. An adaptive factor a on a block of the state is an inflation by 1/a of
    /// each of the block's states.
    ///
    /// # Errors
    /// [`Error::IndexOutOfRange`], [`Error::NotPositive`] for a negative factor, or
    /// [`Error::NotFinite`] if the variance would cease to be finite; P is untouched.
    #[inline]
    pub fn inflate(&mut self, index: usize, factor: T) -> Result<(), Error> {
        if index >= N {
            return Err(Error::IndexOutOfRange);
        }
        if factor < T::ZERO {
            return Err(Error::NotPositive);
        }
        let variance = self.at(index, index) * factor;
        let root = factor.sqrt();
        if !(factor.is_finite() && variance.is_finite()) {
            return Err(Error::NotFinite);
        }
        self.scale_component(index, root);
        *self.entry(index, index) = variance;
        Ok(())
    }
}
