//! Models of a system: its process and its measurements.

use crate::{Covariance, Error, Gaussian, SparseRow};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// A process model: how a state of N components changes over one step.
pub trait Process<T: Scalar, const N: usize> {
    /// x ← f(x), P ← F P Fᵀ + Q with F = ∂f/∂x at the old x.
    ///
    /// Sums may run out of range: [`Gaussian::advance`] checks the result and discards it.
    fn advance(&self, estimate: &mut Gaussian<T, N>);
}

/// A scalar measurement of N states: the measured value and its model.
///
/// One type for each kind of sensor, with the measured value z and whatever else h(x) needs. The noise is not part of
/// it: it belongs to the filter that weighs the measurement, and may be learnt.
pub trait Observation<T: Scalar, const N: usize> {
    /// ∂h/∂x as pairs of a state's index and the derivative with respect to it; states not named have derivative zero.
    /// Usually a [`SparseRow`].
    type Row: AsRef<[(usize, T)]>;

    /// ν = z − h(x) and the row ∂h/∂x. The model takes the difference itself, so that it can wrap angles.
    ///
    /// # Errors
    /// [`Error::NotLinearisable`], or any other error that keeps the model from predicting the measurement at this x.
    fn linearise(&self, mean: &SVector<T, N>) -> Result<(T, Self::Row), Error>;
}

/// The linear process x ← F x with noise Q.
#[derive(Clone, Copy, Debug)]
pub struct Linear<'a, T: Scalar, const N: usize> {
    /// F, the transition of one step.
    pub f: &'a SMatrix<T, N, N>,
    /// Q, the process noise of one step.
    pub q: &'a Covariance<T, N>,
}

impl<T: Scalar, const N: usize> Process<T, N> for Linear<'_, T, N> {
    #[inline]
    fn advance(&self, estimate: &mut Gaussian<T, N>) {
        let mut mean = SVector::<T, N>::zeros();
        for row in 0..N {
            let mut sum = T::accumulator();
            for column in 0..N {
                sum =
                    T::mac(sum, self.f.as_columns()[column][row], estimate.mean.as_array()[column]);
            }
            mean.as_array_mut()[row] = T::finish(sum);
        }
        estimate.mean = mean;
        estimate.covariance = estimate.covariance.transformed(self.f);
        estimate.covariance.add(self.q);
    }
}

/// The linear measurement z = h·x.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LinearObservation<T, const K: usize> {
    /// h, the row of the measurement matrix.
    pub row: SparseRow<T, K>,
    /// z, the measured value, in the measurement's unit.
    pub measured: T,
}

impl<T: Scalar, const N: usize, const K: usize> Observation<T, N> for LinearObservation<T, K> {
    type Row = SparseRow<T, K>;

    #[inline]
    fn linearise(&self, mean: &SVector<T, N>) -> Result<(T, SparseRow<T, K>), Error> {
        let expected = self.row.dot(mean).ok_or(Error::IndexOutOfRange)?;
        // In fixed point the difference may leave the rail.
        if !(T::IS_FLOAT || self.measured.is_finite() && expected.is_finite()) {
            return Err(Error::NotFinite);
        }
        Ok((self.measured - expected, self.row))
    }
}
