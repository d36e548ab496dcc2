//! Models of a system: its process and its measurements.

use crate::{Covariance, Error, Gaussian, SparseRow};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// Process model: the change of a state of N components over one step.
pub trait Process<T: Scalar, const N: usize> {
    /// x ← f(x), P ← F P Fᵀ + Q with F = ∂f/∂x at the old x.
    ///
    /// Sums may run out of range: [`Gaussian::advance`] looks at the result and drops it.
    fn advance(&self, estimate: &mut Gaussian<T, N>);
}

/// A scalar measurement of N states: what was measured, and by which model.
///
/// A type a sensor, with the measured value z and whatever else h(x) needs. The noise is no part of it: it
/// belongs to who weighs, and may be learnt.
pub trait Observation<T: Scalar, const N: usize> {
    /// ∂h/∂x as pairs of a state's index and the derivative by it; what is not named is zero. Usually a
    /// [`SparseRow`].
    type Row: AsRef<[(usize, T)]>;

    /// ν = z − h(x) and the row ∂h/∂x. The difference is the model's, so that angles can be wrapped.
    ///
    /// # Errors
    /// [`Error::NotLinearisable`], or whatever else keeps the model from an expectation at this x.
    fn linearise(&self, mean: &SVector<T, N>) -> Result<(T, Self::Row), Error>;
}

/// The linear process x ← F x with noise Q.
#[derive(Clone, Copy, Debug)]
pub struct Linear<'a, T: Scalar, const N: usize> {
    /// Transition of one step.
    pub f: &'a SMatrix<T, N, N>,
    /// Process noise of one step.
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
    /// h.
    pub row: SparseRow<T, K>,
    /// z, in the measurement's unit.
    pub measured: T,
}

impl<T: Scalar, const N: usize, const K: usize> Observation<T, N> for LinearObservation<T, K> {
    type Row = SparseRow<T, K>;

    #[inline]
    fn linearise(&self, mean: &SVector<T, N>) -> Result<(T, SparseRow<T, K>), Error> {
        let expected = self.row.dot(mean).ok_or(Error::IndexOutOfRange)?;
        Ok((self.measured - expected, self.row))
    }
}
