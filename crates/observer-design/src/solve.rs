//! Linear equations.

use core::mem;

use crate::number::{Number, Square};
use kestirim_scalar::Columns;
use nalgebra::SMatrix;

/// A matrix after elimination with row exchanges, ready for any number of right-hand sides.
pub(crate) struct Eliminated<T: Number, const N: usize> {
    /// Pivots on the diagonal; off it, the multiple of the pivot's row subtracted from each row. Stored by columns.
    factors: [[T; N]; N],
    /// Index of the row exchanged at each step.
    pivots: [usize; N],
}

impl<T: Number, const N: usize> Eliminated<T, N> {
    /// Eliminates; `None` if the matrix is singular to the last bit.
    pub(crate) fn new(matrix: &Square<T, N>) -> Option<Self> {
        let (mut a, mut pivots) = (*matrix.as_columns(), [0; N]);
        for place in 0..N {
            let (pivot, magnitude) = largest(&a[place], place)?;
            if magnitude == 0.0 || !magnitude.is_finite() {
                return None;
            }
            pivots[place] = pivot;
            for column in &mut a {
                swap(column, place, pivot);
            }
            let divisor = a[place][place];
            for row in 0..N {
                if row == place || a[place][row].is_zero() {
                    continue;
                }
                let factor = a[place][row] / divisor;
                a[place][row] = factor;
                for column in a.iter_mut().skip(place + 1) {
                    let taken = factor * column[place];
                    column[row] -= taken;
                }
            }
        }
        Some(Self { factors: a, pivots })
    }

    /// Solves A X = B for X.
    pub(crate) fn solve<const M: usize>(&self, b: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        let mut x = *b;
        for x in x.as_columns_mut() {
            for place in 0..N {
                swap(x, place, self.pivots[place]);
            }
            for place in 0..N {
                for row in 0..N {
                    let factor = self.factors[place][row];
                    if row == place || factor.is_zero() {
                        continue;
                    }
                    let taken = factor * x[place];
                    x[row] -= taken;
                }
            }
            for place in 0..N {
                x[place] /= self.factors[place][place];
            }
        }
        x
    }
}

/// Solves A X = B for X; `None` if A is singular to the last bit.
pub(crate) fn solve<T: Number, const N: usize, const M: usize>(
    a: &Square<T, N>,
    b: &SMatrix<T, N, M>,
) -> Option<SMatrix<T, N, M>> {
    Some(Eliminated::new(a)?.solve(b))
}

/// A⁻¹; `None` if A is singular to the last bit.
pub(crate) fn inverse<T: Number, const N: usize>(a: &Square<T, N>) -> Option<Square<T, N>> {
    solve(a, &Square::identity())
}

/// Index and magnitude of the largest element of a column, from row `from` down.
fn largest<T: Number>(column: &[T], from: usize) -> Option<(usize, f64)> {
    let sizes = column.iter().map(|value| value.magnitude()).enumerate().skip(from);
    sizes.reduce(|best, other| if other.1 > best.1 { other } else { best })
}

fn swap<T>(column: &mut [T], first: usize, second: usize) {
    if let Ok([first, second]) = column.get_disjoint_mut([first, second]) {
        mem::swap(first, second);
    }
}
