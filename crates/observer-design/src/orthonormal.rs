//! Orthonormal bases.

use crate::extended::Extended;
use crate::number::{Number, Real, Square};
use kestirim_scalar::{Columns, Components};
use nalgebra::{Complex, SVector};

/// An orthonormal basis of the whole space, whose first k vectors span the first k columns for each k up to `count`;
/// `None` if these columns are linearly dependent. The remaining vectors span the orthogonal complement.
pub(crate) fn complete<T: Number, const N: usize>(
    columns: &Square<T, N>,
    count: usize,
) -> Option<Square<T, N>> {
    let mut basis = Square::<T, N>::zeros();
    for index in 0..N {
        let vector = if index < count {
            let column = SVector::from(columns.as_columns()[index]);
            normalised(&column, 0.0)
                .and_then(|column| normalised(&residual(&column, &basis, index), 1e-24))
        } else {
            farthest(&basis, index)
        };
        basis.as_columns_mut()[index] = *vector?.as_array();
    }
    Some(basis)
}

/// The unit vector of the axis farthest from the span of the first `count` vectors, made orthogonal to them.
fn farthest<T: Number, const N: usize>(
    basis: &Square<T, N>,
    count: usize,
) -> Option<SVector<T, N>> {
    let mut covered = [0.0; N];
    for vector in basis.as_columns().iter().take(count) {
        for (covered, part) in covered.iter_mut().zip(vector) {
            *covered += part.squared().rounded();
        }
    }
    let (axis, _) = covered.iter().enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let unit = SVector::from_fn(|index, _| if index == axis { T::one() } else { T::zero() });
    normalised(&residual(&unit, basis, count), 0.0)
}

/// The part of a vector orthogonal to the first `count` vectors of a basis. Projected twice, because one projection
/// leaves rounding behind.
fn residual<T: Number, const N: usize>(
    vector: &SVector<T, N>,
    basis: &Square<T, N>,
    count: usize,
) -> SVector<T, N> {
    let mut rest = *vector;
    for _ in 0..2 {
        for &base in basis.as_columns().iter().take(count) {
            let base = SVector::from(base);
            let part = inner(&base, &rest);
            rest -= base * part;
        }
    }
    rest
}

/// The inner product aᴴ b.
pub(crate) fn inner<T: Number, const N: usize>(a: &SVector<T, N>, b: &SVector<T, N>) -> T {
    a.iter().zip(b.iter()).fold(T::zero(), |sum, (&a, &b)| sum + a.conjugate() * b)
}

/// The Euclidean norm ‖a‖.
pub(crate) fn length<T: Number, const N: usize>(a: &SVector<T, N>) -> T::Real {
    a.iter().fold(T::Real::from(0.0), |sum, &value| sum + value.squared()).square_root()
}

/// The vector scaled to length 1; `None` if its length is at most `least`, or not finite.
pub(crate) fn normalised<T: Number, const N: usize>(
    vector: &SVector<T, N>,
    least: f64,
) -> Option<SVector<T, N>> {
    let length = length(vector);
    let long_enough = length.rounded() > least && length.rounded().is_finite();
    let reciprocal = T::Real::from(1.0) / length;
    long_enough.then(|| vector.map(|value| value.scaled(reciprocal)))
}

/// A vector along no axis, as a start of inverse iterations.
pub(crate) fn oblique<const N: usize>() -> SVector<Complex<Extended>, N> {
    SVector::from_fn(|index, _| Complex::from(Extended::from(1.0 + index as f64 / 7.0)))
}
