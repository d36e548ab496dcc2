//! Linear equations.

use crate::number::{Number, Square};
use nalgebra::SMatrix;

/// X of A X = B, by elimination with row exchanges; nothing where A is singular to the last bit.
pub(crate) fn solve<T: Number, const N: usize, const M: usize>(
    a: &Square<T, N>,
    b: &SMatrix<T, N, M>,
) -> Option<SMatrix<T, N, M>> {
    let (mut a, mut b) = (*a, *b);
    for column in 0..N {
        let pivot = largest(&a, column);
        let divisor = a[(pivot, column)];
        let magnitude = divisor.magnitude();
        if magnitude == 0.0 || !magnitude.is_finite() {
            return None;
        }
        a.swap_rows(column, pivot);
        b.swap_rows(column, pivot);
        for row in 0..N {
            if row == column || a[(row, column)].is_zero() {
                continue;
            }
            let factor = a[(row, column)] / divisor;
            for index in column..N {
                let taken = factor * a[(column, index)];
                a[(row, index)] -= taken;
            }
            for index in 0..M {
                let taken = factor * b[(column, index)];
                b[(row, index)] -= taken;
            }
        }
    }
    for row in 0..N {
        let divisor = a[(row, row)];
        for index in 0..M {
            b[(row, index)] /= divisor;
        }
    }
    Some(b)
}

/// A⁻¹.
pub(crate) fn inverse<T: Number, const N: usize>(a: &Square<T, N>) -> Option<Square<T, N>> {
    solve(a, &Square::identity())
}

/// The row, from the diagonal down, with the largest element of a column.
fn largest<T: Number, const N: usize>(a: &Square<T, N>, column: usize) -> usize {
    let mut best = column;
    for row in column..N {
        if a[(row, column)].magnitude() > a[(best, column)].magnitude() {
            best = row;
        }
    }
    best
}
