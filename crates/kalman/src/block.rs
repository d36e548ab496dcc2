//! Updates by several measurements with correlated noise at once.

use crate::{Covariance, Error, Gaussian, SparseRow};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// Innovation of M correlated measurements: their differences from what was expected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BlockInnovation<T: Scalar, const M: usize> {
    /// ν = z − h(x), as given by the caller.
    pub innovation: SVector<T, M>,
    /// S = H P Hᵀ + R, the covariance of the innovation.
    pub covariance: Covariance<T, M>,
    /// νᵀ S⁻¹ ν: M on average when the model is right.
    pub nis: T,
}

impl<T: Scalar, const N: usize> Gaussian<T, N> {
    /// Takes in M measurements at once, with innovations ν = z − h(x), rows H and noise R of any
    /// correlation.
    ///
    /// With R = L D Lᵀ (L with a unit diagonal), L⁻¹z are measurements of independent variances D,
    /// which are taken in one after the other. The estimate is the textbook's, without the inverse
    /// of S. Where R is diagonal, [`Gaussian::update`] for each measurement does the same at lower
    /// cost.
    ///
    /// # Errors
    /// [`Error::NotFinite`], or [`Error::NotPositive`] if R or S is not positive definite; the
    /// estimate is untouched.
    pub fn update_block<const M: usize>(
        &mut self,
        rows: &SMatrix<T, M, N>,
        innovation: &SVector<T, M>,
        noise: &Covariance<T, M>,
    ) -> Result<BlockInnovation<T, M>, Error> {
        // In fixed point a difference may leave the rail.
        if !(T::IS_FLOAT || T::all_finite(innovation.as_array())) {
            return Err(Error::NotFinite);
        }
        let covariance = self.expected_spread(rows, noise);
        let (rows, independent, variances) = decorrelated(rows, innovation, noise)?;
        let mut next = *self;
        let mut nis = T::ZERO;
        for m in 0..M {
            let row =
                SparseRow::<T, N>::new(core::array::from_fn(|n| (n, rows.as_columns()[n][m])));
            let moved = row.dot(&(next.mean - self.mean)).ok_or(Error::IndexOutOfRange)?;
            nis += next.update(&row, independent.as_array()[m] - moved, variances[m])?.nis;
        }
        *self = next;
        Ok(BlockInnovation { innovation: *innovation, covariance, nis })
    }

    /// S = H P Hᵀ + R.
    fn expected_spread<const M: usize>(
        &self,
        rows: &SMatrix<T, M, N>,
        noise: &Covariance<T, M>,
    ) -> Covariance<T, M> {
        let mut spread = SMatrix::<T, M, M>::zeros();
        for m in 0..M {
            let mut cross = [T::ZERO; N];
            for (i, cross) in cross.iter_mut().enumerate() {
                let mut sum = T::accumulator();
                for n in 0..N {
                    sum = T::mac(sum, self.covariance.at(i, n), rows.as_columns()[n][m]);
                }
                *cross = T::finish(sum);
            }
            for other in m..M {
                let mut sum = T::accumulator();
                for n in 0..N {
                    sum = T::mac(sum, rows.as_columns()[n][other], cross[n]);
                }
                spread.as_columns_mut()[m][other] = T::finish(sum);
            }
        }
        let mut covariance = Covariance::from_lower_triangle(&spread);
        covariance.add(noise);
        covariance
    }
}

type Decorrelated<T, const M: usize, const N: usize> = (SMatrix<T, M, N>, SVector<T, M>, [T; M]);

/// L⁻¹H, L⁻¹ν and D of R = L D Lᵀ, by forward substitution during the factorisation.
fn decorrelated<T: Scalar, const M: usize, const N: usize>(
    rows: &SMatrix<T, M, N>,
    innovation: &SVector<T, M>,
    noise: &Covariance<T, M>,
) -> Result<Decorrelated<T, M, N>, Error> {
    let (mut rows, mut innovation, mut rest) = (*rows, *innovation, noise.to_matrix());
    let mut variances = [T::ZERO; M];
    for pivot in 0..M {
        let variance = rest.as_columns()[pivot][pivot];
        if variance <= T::ZERO {
            return Err(Error::NotPositive);
        }
        variances[pivot] = variance;
        let divisor = variance.divisor();
        for row in pivot + 1..M {
            let factor = rest.as_columns()[pivot][row].divided_by(divisor);
            for column in pivot + 1..M {
                let taken = factor * rest.as_columns()[column][pivot];
                rest.as_columns_mut()[column][row] -= taken;
            }
            for column in 0..N {
                let taken = factor * rows.as_columns()[column][pivot];
                rows.as_columns_mut()[column][row] -= taken;
            }
            let taken = factor * innovation.as_array()[pivot];
            innovation.as_array_mut()[row] -= taken;
        }
    }
    // NaN passes every comparison above, and fixed point may have reached a rail.
    let are_finite = T::IS_FLOAT
        || T::all_finite(innovation.as_array()) && T::all_finite(rows.as_columns().as_flattened());
    if T::all_finite(&variances) && are_finite {
        Ok((rows, innovation, variances))
    } else {
        Err(Error::NotFinite)
    }
}
