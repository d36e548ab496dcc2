//! Inflation of the covariance of a few states.

use crate::{Covariance, Error};
use kestirim_scalar::Scalar;

impl<T: Scalar, const N: usize> Covariance<T, N> {
    /// Multiplies the covariance block of `count` states from index `first` on by `factor` ≥ 1, and leaves
    /// their covariances with the other states as they are.
    ///
    /// This is process noise in proportion to the block's own uncertainty: P stays positive, and an innovation
    /// that the block explains is not attributed to states correlated with it. (Were the correlations kept
    /// instead, a moving receiver would shift its ambiguities.) Rounding is left to the next update, like
    /// that of a [`Covariance::shear`].
    ///
    /// # Errors
    /// [`Error::IndexOutOfRange`], [`Error::NotPositive`] for a factor below one, or
    /// [`Error::NotFinite`] if a variance would become infinite; P is untouched.
    #[inline]
    pub fn inflate(&mut self, first: usize, count: usize, factor: T) -> Result<(), Error> {
        let end = first.checked_add(count).filter(|&end| end <= N);
        let end = end.ok_or(Error::IndexOutOfRange)?;
        if !factor.is_finite() {
            return Err(Error::NotFinite);
        }
        if factor < T::ONE {
            return Err(Error::NotPositive);
        }
        let overflows = |state: usize| !(self.at(state, state) * factor).is_finite();
        if (first..end).any(overflows) {
            return Err(Error::NotFinite);
        }
        for column in first..end {
            for row in column..end {
                *self.entry(row, column) *= factor;
            }
        }
        Ok(())
    }
}
