//! Number types of the linear algebra: real or complex, with 53 or 106 bits.

use core::ops::Neg;

use crate::extended::Extended;
use kestirim_scalar::Columns;
use nalgebra::{Complex, SMatrix};
use num_traits::NumAssign;

/// A field element that can be ordered by magnitude.
pub(crate) trait Number: nalgebra::Scalar + Copy + NumAssign + Neg<Output = Self> {
    /// The type of the real and imaginary parts.
    type Real: Real;

    /// |x|, with the precision of a double.
    fn magnitude(self) -> f64;
    /// The complex conjugate.
    fn conjugate(self) -> Self;
    /// |x|².
    fn squared(self) -> Self::Real;
    /// r x, the product with a real factor.
    fn scaled(self, factor: Self::Real) -> Self;
}

/// A real [`Number`].
pub(crate) trait Real: Number<Real = Self> + PartialOrd + From<f64> {
    fn square_root(self) -> Self;
    fn rounded(self) -> f64;
}

impl Number for f64 {
    type Real = Self;
    fn magnitude(self) -> f64 {
        self.abs()
    }
    fn conjugate(self) -> Self {
        self
    }
    fn squared(self) -> Self {
        self * self
    }
    fn scaled(self, factor: Self) -> Self {
        self * factor
    }
}

impl Real for f64 {
    fn square_root(self) -> Self {
        libm::sqrt(self.max(0.0))
    }
    fn rounded(self) -> f64 {
        self
    }
}

impl Number for Extended {
    type Real = Self;
    fn magnitude(self) -> f64 {
        self.to_f64().abs()
    }
    fn conjugate(self) -> Self {
        self
    }
    fn squared(self) -> Self {
        self * self
    }
    fn scaled(self, factor: Self) -> Self {
        self * factor
    }
}

impl Real for Extended {
    fn square_root(self) -> Self {
        self.sqrt()
    }
    fn rounded(self) -> f64 {
        self.to_f64()
    }
}

impl<R: Real> Number for Complex<R> {
    type Real = R;
    fn magnitude(self) -> f64 {
        libm::hypot(self.re.rounded(), self.im.rounded())
    }
    fn conjugate(self) -> Self {
        Self { re: self.re, im: -self.im }
    }
    fn squared(self) -> R {
        self.re * self.re + self.im * self.im
    }
    fn scaled(self, factor: R) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}

/// A square matrix.
pub(crate) type Square<T, const N: usize> = SMatrix<T, N, N>;

/// The matrix with every element as a number of 106 bits.
pub(crate) fn extend<const R: usize, const C: usize>(
    matrix: &SMatrix<f64, R, C>,
) -> SMatrix<Extended, R, C> {
    matrix.map(Extended::from)
}

/// The matrix with every element rounded to the nearest double.
pub(crate) fn round<const R: usize, const C: usize>(
    matrix: &SMatrix<Extended, R, C>,
) -> SMatrix<f64, R, C> {
    matrix.map(Extended::to_f64)
}

/// A real matrix as a complex one.
pub(crate) fn complex<const R: usize, const C: usize>(
    matrix: &SMatrix<Extended, R, C>,
) -> SMatrix<Complex<Extended>, R, C> {
    matrix.map(Complex::from)
}

/// A complex double as a number of 106 bits.
pub(crate) fn extend_complex(value: Complex<f64>) -> Complex<Extended> {
    Complex { re: Extended::from(value.re), im: Extended::from(value.im) }
}

/// The nearest complex double.
pub(crate) fn round_complex(value: Complex<Extended>) -> Complex<f64> {
    Complex { re: value.re.to_f64(), im: value.im.to_f64() }
}

/// Products of matrices. Those of `nalgebra` also multiply by factors of one and add multiples of zero, which is
/// three times the work for double-word numbers, and they are unrolled at every call, which takes kilobytes.
pub(crate) trait Times<T: Number, const K: usize, const C: usize> {
    type Product;

    /// The product A B.
    fn times(&self, other: &SMatrix<T, K, C>) -> Self::Product;
}

impl<T: Number, const R: usize, const K: usize, const C: usize> Times<T, K, C>
    for SMatrix<T, R, K>
{
    type Product = SMatrix<T, R, C>;

    #[inline(never)]
    fn times(&self, other: &SMatrix<T, K, C>) -> SMatrix<T, R, C> {
        let mut product = SMatrix::<T, R, C>::zeros();
        for (sums, factors) in product.as_columns_mut().iter_mut().zip(other.as_columns()) {
            for (column, &factor) in self.as_columns().iter().zip(factors) {
                for (sum, &element) in sums.iter_mut().zip(column) {
                    *sum += element * factor;
                }
            }
        }
        product
    }
}

/// The conjugate transpose.
pub(crate) fn adjoint<T: Number, const R: usize, const C: usize>(
    matrix: &SMatrix<T, R, C>,
) -> SMatrix<T, C, R> {
    matrix.transpose().map(T::conjugate)
}

/// The 1-norm: the largest sum of magnitudes of a column.
pub(crate) fn norm<T: Number, const R: usize, const C: usize>(matrix: &SMatrix<T, R, C>) -> f64 {
    let sum = |column: &[T; R]| column.iter().map(|value| value.magnitude()).sum::<f64>();
    matrix.as_columns().iter().map(sum).fold(0.0, f64::max)
}

/// Whether every element is finite.
pub(crate) fn finite<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> bool {
    matrix.iter().all(|value| value.is_finite())
}

/// A − `shift` · I.
pub(crate) fn shifted<T: Number, const N: usize>(matrix: &Square<T, N>, shift: T) -> Square<T, N> {
    let mut result = *matrix;
    for index in 0..N {
        result[(index, index)] -= shift;
    }
    result
}

/// The symmetric part ½ (A + Aᵀ).
pub(crate) fn symmetrised<const N: usize>(matrix: &Square<Extended, N>) -> Square<Extended, N> {
    let half = Extended::from(0.5);
    (matrix + matrix.transpose()).map(|value| value * half)
}

/// The largest power of two not above `size`; 1 if `size` is not a normal number.
pub(crate) fn power_of_two(size: f64) -> f64 {
    const EXPONENT: u64 = 0x7FF << 52;
    if size.is_normal() { f64::from_bits(size.to_bits() & EXPONENT) } else { 1.0 }
}
