//! What a system tells the filter: how its state moves on, and what a measurement of it would show.

use crate::{Covariance, Error, Gaussian, SparseRow};
use kestirim_scalar::Scalar;
use nalgebra::{SMatrix, SVector};

/// How a state of N components moves on over one step.
pub trait Process<T: Scalar, const N: usize> {
    /// x ← f(x), P ← F P Fᵀ + Q with F = ∂f/∂x at the old x.
    ///
    /// Sums may run out of range: [`Gaussian::advance`] looks at the result and drops it.
    fn advance(&self, estimate: &mut Gaussian<T, N>);
}

/// What a scalar measurement of N states shows, of which it touches K.
pub trait Observation<T: Scalar, const N: usize, const K: usize> {
    /// h(x) and the row ∂h/∂x.
    ///
    /// # Errors
    /// Whatever keeps the model from an expectation at this x.
    fn expect(&self, mean: &SVector<T, N>) -> Result<(T, SparseRow<T, K>), Error>;
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
        let mut mean = SVector::zeros();
        for row in 0..N {
            let mut sum = T::accumulator();
            for column in 0..N {
                sum = T::mac(sum, self.f.data.0[column][row], estimate.mean.data.0[0][column]);
            }
            mean.data.0[0][row] = T::finish(sum);
        }
        estimate.mean = mean;
        estimate.covariance = estimate.covariance.transformed(self.f);
        estimate.covariance.add(self.q);
    }
}

/// A linear measurement is its row.
impl<T: Scalar, const N: usize, const K: usize> Observation<T, N, K> for SparseRow<T, K> {
    #[inline]
    fn expect(&self, mean: &SVector<T, N>) -> Result<(T, SparseRow<T, K>), Error> {
        Ok((self.dot(mean).ok_or(Error::IndexOutOfRange)?, *self))
    }
}
