use nalgebra::SMatrix;

use crate::Error;

/// X of A·X = B, by elimination with the largest pivot of each column.
///
/// A column without a pivot has none larger than its own rounding errors: [`Error::Singular`].
pub(crate) fn solve<const N: usize, const M: usize>(
    mut a: SMatrix<f64, N, N>,
    mut b: SMatrix<f64, N, M>,
) -> Result<SMatrix<f64, N, M>, Error> {
    if a.iter().chain(b.iter()).any(|number| !number.is_finite()) {
        return Err(Error::NotFinite);
    }
    let mut size = [0.0_f64; N];
    for column in 0..N {
        size[column] = a.column(column).iter().fold(0.0, |most, x| most.max(libm::fabs(*x)));
    }
    for column in 0..N {
        let mut pivot = column;
        for row in column + 1..N {
            if libm::fabs(a[(row, column)]) > libm::fabs(a[(pivot, column)]) {
                pivot = row;
            }
        }
        if libm::fabs(a[(pivot, column)]) <= N as f64 * f64::EPSILON * size[column] {
            return Err(Error::Singular);
        }
        a.swap_rows(column, pivot);
        b.swap_rows(column, pivot);
        for row in 0..N {
            if row == column {
                continue;
            }
            let factor = a[(row, column)] / a[(column, column)];
            for k in column..N {
                let above = a[(column, k)];
                a[(row, k)] -= factor * above;
            }
            for k in 0..M {
                let above = b[(column, k)];
                b[(row, k)] -= factor * above;
            }
        }
    }
    Ok(SMatrix::from_fn(|row, k| b[(row, k)] / a[(row, row)]))
}
