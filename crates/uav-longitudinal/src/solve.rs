use kestirim_scalar::Columns;
use nalgebra::SMatrix;

use crate::Error;

/// Solves A·X = B by Gauss-Jordan elimination with partial pivoting.
///
/// Returns [`Error::Singular`] if a column's largest pivot does not exceed its own rounding errors.
pub(crate) fn solve<const N: usize, const M: usize>(
    mut a: SMatrix<f64, N, N>,
    mut b: SMatrix<f64, N, M>,
) -> Result<SMatrix<f64, N, M>, Error> {
    if a.iter().chain(b.iter()).any(|number| !number.is_finite()) {
        return Err(Error::NotFinite);
    }
    let (left, right) = (a.as_columns_mut(), b.as_columns_mut());
    let size = left.map(|column| column.iter().fold(0.0, |most: f64, x| most.max(libm::fabs(*x))));
    for column in 0..N {
        let (mut pivot, mut largest) = (column, libm::fabs(left[column][column]));
        for row in column + 1..N {
            if libm::fabs(left[column][row]) > largest {
                (pivot, largest) = (row, libm::fabs(left[column][row]));
            }
        }
        if largest <= N as f64 * f64::EPSILON * size[column] {
            return Err(Error::Singular);
        }
        swap_rows(left, column, pivot);
        swap_rows(right, column, pivot);
        for row in 0..N {
            if row == column {
                continue;
            }
            let factor = left[column][row] / left[column][column];
            for k in column..N {
                left[k][row] -= factor * left[k][column];
            }
            for k in 0..M {
                right[k][row] -= factor * right[k][column];
            }
        }
    }
    for column in right {
        for row in 0..N {
            column[row] /= left[row][row];
        }
    }
    Ok(b)
}

/// Swaps two rows of a matrix stored by columns, if both exist.
fn swap_rows<const N: usize, const M: usize>(columns: &mut [[f64; N]; M], i: usize, j: usize) {
    for column in columns {
        if i < N && j < N {
            column.swap(i, j);
        }
    }
}
