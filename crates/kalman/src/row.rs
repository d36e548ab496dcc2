use crate::innovation::Weights;
use crate::{Error, Gaussian, Weighed};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// One row of a measurement matrix H with at most `K` entries that are not zero.
///
/// A range to an anchor depends on two or three of the states, a zero-velocity measurement on one:
/// zeros are neither stored nor multiplied. Where the indices are literals, the compiler resolves every
/// access.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SparseRow<T, const K: usize> {
    entries: [(usize, T); K],
}

impl<T: Scalar, const K: usize> SparseRow<T, K> {
    /// A row from pairs of a state's index and ∂h/∂(that state). Entries of the same index add up.
    #[inline]
    pub const fn new(entries: [(usize, T); K]) -> Self {
        Self { entries }
    }

    /// The entries, as pairs of a state's index and the derivative.
    #[inline]
    pub const fn entries(&self) -> &[(usize, T); K] {
        &self.entries
    }

    /// h·x, the value that a linear measurement model predicts; `None` if an index is beyond the state.
    #[inline]
    pub fn dot<const N: usize>(&self, state: &SVector<T, N>) -> Option<T> {
        let mut sum = T::accumulator();
        for &(index, value) in &self.entries {
            sum = T::mac(sum, value, *state.as_array().get(index)?);
        }
        Some(T::finish(sum))
    }
}

impl<T, const K: usize> AsRef<[(usize, T)]> for SparseRow<T, K> {
    #[inline(always)]
    fn as_ref(&self) -> &[(usize, T)] {
        &self.entries
    }
}

impl<T: Scalar, const N: usize> Gaussian<T, N> {
    /// [`Gaussian::weigh`] for a row that is known only at run time: ∂h/∂x for each state. Zeros cost next to
    /// nothing.
    ///
    /// # Errors
    /// As [`Gaussian::update`].
    #[inline(always)]
    pub fn weigh_row(
        &self,
        row: &[T; N],
        innovation: T,
        variance: T,
    ) -> Result<Weighed<T, N>, Error> {
        let mut sums = [T::accumulator(); N];
        for (index, &value) in row.iter().enumerate() {
            if value != T::ZERO {
                for (other, sum) in sums.iter_mut().enumerate() {
                    *sum = T::mac(*sum, value, self.covariance.at(index, other));
                }
            }
        }
        let cross = sums.map(T::finish);
        let weights = Weights::new(innovation, T::dot(row, &cross), variance)?;
        Ok(Weighed { weights, cross })
    }
}
