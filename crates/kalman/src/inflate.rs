//! Inflation of the covariance of a few states.

use crate::{Covariance, Error};
use kestirim_scalar::Scalar;

impl<T: Scalar, const N: usize> Covariance<T, N> {
    /// Multiplies the covariance of `count` states from index `first` on among each other by `factor` ≥ 1,
    /// and leaves their covariances with the other states.
    ///
    /// That is process noise in proportion to what the block is uncertain by: P stays positive, and a
    /// surprise in the block is not taken for one in states that correlate with it. (Had the
    /// correlations been kept, a receiver that moves would move its ambiguities.) Rounding is left to
    /// the next update, as that of a [`Covariance::shear`] is.
    ///
    /// # Errors
    /// [`Error::IndexOutOfRange`], [`Error::NotPositive`] for a factor below one, or
    /// [`Error::NotFinite`] if a variance would cease to be finite; P is untouched.
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
