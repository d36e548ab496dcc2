use core::array::from_fn;

use crate::{Covariance, Gaussian, Process};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::SMatrix;

/// A process in which the first K states move the first M ≤ K, and the others only fade: biases, gusts, trims.
///
/// `x[..M]` ← F x\[..K\]; `x[i]` ← dᵢ xᵢ for i ≥ M; with noise Q. Of the N² M + N M² products of a dense F with as many
/// rows, M N K + M² K / 2 remain.
#[derive(Clone, Copy, Debug)]
pub struct Driven<'a, T: Scalar, const N: usize, const M: usize, const K: usize> {
    /// The first M rows of F, over the K states that move something.
    pub rows: &'a SMatrix<T, M, K>,
    /// d, the fraction of each other state that is left after a step; the first M entries are ignored.
    pub fading: &'a [T; N],
    /// Q, the process noise of one step.
    pub noise: &'a Covariance<T, N>,
}

impl<T: Scalar, const N: usize, const M: usize, const K: usize> Process<T, N>
    for Driven<'_, T, N, M, K>
{
    #[inline]
    fn advance(&self, estimate: &mut Gaussian<T, N>) {
        const { assert!(M <= K && K <= N, "states that move are among those that move them") };
        let Gaussian { mean, covariance } = estimate;
        let (f, q) = (self.rows.as_columns(), self.noise);
        // F P, computed before P is overwritten.
        let mut moved = [[T::ZERO; M]; N];
        for (state, moved) in moved.iter_mut().enumerate() {
            *moved = self.moved(&from_fn(|k| covariance.at(k, state)));
        }
        for column in 0..M {
            for row in column..M {
                let mut sum = T::accumulator();
                for k in 0..K {
                    sum = T::mac(sum, f[k][column], moved[k][row]);
                }
                *covariance.entry(row, column) = T::finish(sum) + q.at(row, column);
            }
            for row in M..N {
                let faded = moved[row][column] * self.fading[row];
                *covariance.entry(row, column) = faded + q.at(row, column);
            }
        }
        for column in M..N {
            for row in column..N {
                let entry = covariance.entry(row, column);
                *entry = *entry * (self.fading[column] * self.fading[row]) + q.at(row, column);
            }
        }
        let mean = mean.as_array_mut();
        let moved = self.moved(&from_fn(|k| mean[k]));
        for row in 0..N {
            mean[row] = if row < M { moved[row] } else { mean[row] * self.fading[row] };
        }
    }
}

impl<T: Scalar, const N: usize, const M: usize, const K: usize> Driven<'_, T, N, M, K> {
    /// F times a vector of the first K states.
    #[inline(always)]
    fn moved(&self, column: &[T; K]) -> [T; M] {
        let f = self.rows.as_columns();
        from_fn(|row| {
            let mut sum = T::accumulator();
            for k in 0..K {
                sum = T::mac(sum, f[k][row], column[k]);
            }
            T::finish(sum)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;

    #[test]
    fn is_the_dense_prediction_without_what_is_zero() {
        let rows = SMatrix::<f64, 2, 3>::new(0.9, 0.1, 0.3, -0.2, 0.8, -0.4);
        let fading = [7.0, 8.0, 0.95, 1.0, 0.5];
        let mut dense = SMatrix::<f64, 5, 5>::zeros();
        dense.fixed_view_mut::<2, 3>(0, 0).copy_from(&rows);
        for state in 2..5 {
            dense[(state, state)] = fading[state];
        }
        let root = SMatrix::<f64, 5, 5>::from_fn(|i, j| ((3 * i + 7 * j) % 5) as f64 - 1.5);
        let covariance = Covariance::from_lower_triangle(&(root * root.transpose()));
        let noise =
            Covariance::from_lower_triangle(&(SMatrix::identity() + root.transpose() * root));
        let mean = SVector::from([1.0, -2.0, 3.0, 4.0, -5.0]);
        let mut structured = Gaussian::new(mean, covariance);
        let mut plain = structured;
        structured.advance(&Driven { rows: &rows, fading: &fading, noise: &noise }).unwrap();
        plain.predict(&dense, &noise).unwrap();
        assert!((structured.mean - plain.mean).norm() < 1e-12);
        let difference = structured.covariance.to_matrix() - plain.covariance.to_matrix();
        assert!(difference.norm() < 1e-12 * plain.covariance.to_matrix().norm());
    }
}
