//! The matrix algebra that turns gains into coefficients, in double precision and as constant functions: in a
//! `const`, none of it reaches the target.

/// An R × C matrix column by column, as in the storage of `SMatrix`.
pub(crate) type Dense<const R: usize, const C: usize> = [[f64; R]; C];

/// A − I.
pub(crate) const fn less_identity<const N: usize>(a: &Dense<N, N>) -> Dense<N, N> {
    let mut difference = *a;
    let mut i = 0;
    while i < N {
        difference[i][i] -= 1.0;
        i += 1;
    }
    difference
}

/// A − B C.
pub(crate) const fn less_product<const R: usize, const K: usize, const C: usize>(
    a: &Dense<R, C>,
    b: &Dense<R, K>,
    c: &Dense<K, C>,
) -> Dense<R, C> {
    let mut difference = *a;
    let mut column = 0;
    while column < C {
        let mut row = 0;
        while row < R {
            let mut k = 0;
            while k < K {
                difference[column][row] -= b[k][row] * c[column][k];
                k += 1;
            }
            row += 1;
        }
        column += 1;
    }
    difference
}

/// −A.
pub(crate) const fn negative<const R: usize, const C: usize>(a: &Dense<R, C>) -> Dense<R, C> {
    let mut negative = *a;
    let mut column = 0;
    while column < C {
        let mut row = 0;
        while row < R {
            negative[column][row] = -a[column][row];
            row += 1;
        }
        column += 1;
    }
    negative
}

/// The submatrix of A with these row and column indices; zero where an index is beyond A.
pub(crate) const fn part<const N: usize, const M: usize, const R: usize, const C: usize>(
    a: &Dense<N, M>,
    rows: &[usize; R],
    columns: &[usize; C],
) -> Dense<R, C> {
    let mut part = [[0.0; R]; C];
    let mut column = 0;
    while column < C {
        let mut row = 0;
        while row < R {
            if columns[column] < M && rows[row] < N {
                part[column][row] = a[columns[column]][rows[row]];
            }
            row += 1;
        }
        column += 1;
    }
    part
}

/// The indices 0, 1, … N − 1.
pub(crate) const fn all<const N: usize>() -> [usize; N] {
    let mut indices = [0; N];
    let mut i = 0;
    while i < N {
        indices[i] = i;
        i += 1;
    }
    indices
}
