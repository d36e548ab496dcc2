use core::ops::{Add, Div, Mul, Sub};
use core::ops::{AddAssign, DivAssign, MulAssign, Neg, SubAssign};
use num_traits::{One, Zero};

/// A real number type for estimators: `f32`, `f64` or [`Fixed`](crate::Fixed).
///
/// All operations are total: none panics. Where a float returns an infinity or a NaN,
/// fixed point returns one of its two rails ([`Scalar::MIN`], [`Scalar::MAX`]), and
/// [`Scalar::is_finite`] detects both.
pub trait Scalar:
    nalgebra::Scalar
    + Copy
    + Default
    + PartialOrd
    + Zero
    + One
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// A sum of products, wider than `Self`: fixed point rounds it once, when it is finished.
    type Accumulator: nalgebra::Scalar + Copy;
    /// A divisor prepared once for several quotients, over the whole range of `Self`. It is the reciprocal
    /// for floats, and mantissa and shift for fixed point (where the reciprocal of a small number would
    /// overflow).
    type Divisor: Copy + PartialEq + core::fmt::Debug;

    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// ½.
    const HALF: Self;
    /// 2.
    const TWO: Self;
    /// π, rounded to the nearest value.
    const PI: Self;
    /// The distance from 1 to the next larger value.
    const EPSILON: Self;
    /// The smallest value, the lower rail of fixed point.
    const MIN: Self;
    /// The largest value, the upper rail of fixed point.
    const MAX: Self;
    /// The largest whole number up to which all are exact: a sum of as many ones neither saturates nor is rounded.
    const MAX_WHOLE: u32;
    /// Whether this is floating point: there is room for any variance, and sums and products of numbers that are not
    /// finite are not finite either. Fixed point may leave a rail.
    const IS_FLOAT: bool = false;

    /// The nearest value; saturates if out of range. NaN becomes NaN, or the lower rail in fixed point.
    ///
    /// A constant argument is folded to a constant, so that no double-precision code reaches the target.
    fn from_f64(value: f64) -> Self;
    /// The exact value as a double (which holds fixed point with up to 31 fractional bits).
    fn to_f64(self) -> f64;
    /// The value nearest to an `f32`, computed in single precision only (drivers and logs deliver `f32`).
    fn from_f32(value: f32) -> Self;
    /// The nearest `f32`.
    fn to_f32(self) -> f32;
    /// `value · 10⁻⁶`, rounded once: converts microseconds to seconds without double precision.
    fn from_micro(value: i32) -> Self;

    /// `value · 2^exponent`, rounded once, for −126 ≤ exponent ≤ 127. Converts the results of integer computations,
    /// such as random numbers.
    fn from_binary(value: i32, exponent: i32) -> Self;
    /// The integer nearest to `self · 2^−exponent`; saturates. NaN gives 0; the lower rail, which stands for it in
    /// fixed point, converts like any number.
    fn to_binary(self, exponent: i32) -> i32;

    /// Whether the value is neither NaN nor infinite; in fixed point, whether it is on neither rail.
    fn is_finite(self) -> bool;

    /// Whether the value is finite and above zero.
    #[inline]
    fn is_positive(self) -> bool {
        self.is_finite() && self > Self::ZERO
    }

    /// Whether all values are finite.
    #[inline(always)]
    fn all_finite(values: &[Self]) -> bool {
        values.iter().all(|value| value.is_finite())
    }

    /// |x|, saturating.
    fn abs(self) -> Self;
    /// The smaller of two values; `self` if either is NaN.
    #[inline]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// The larger of two values; `self` if either is NaN.
    #[inline]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
    /// The nearest value in `low..=high`; NaN stays NaN.
    #[inline]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }

    /// √x; NaN for a negative number, or the lower rail in fixed point.
    fn sqrt(self) -> Self;
    /// √(x² + y²) without intermediate overflow.
    fn hypot(self, other: Self) -> Self;
    /// √(Σ xᵢ²), for lengths of everyday size: where a square overflows or underflows, so does the result of
    /// a float ([`Scalar::hypot`] avoids that, but is slower).
    fn norm<const N: usize>(components: &[Self; N]) -> Self;
    /// The natural logarithm of [`Scalar::norm`], without its square root.
    fn ln_norm<const N: usize>(components: &[Self; N]) -> Self;
    /// 1/x; infinity for zero, or the upper rail in fixed point.
    fn recip(self) -> Self;
    /// Prepares `self` as the divisor of [`Scalar::divided_by`]; every value is allowed, also zero.
    fn divisor(self) -> Self::Divisor;
    /// `self / divisor`, rounded within one or two units in the last place; division by zero is as with `/`.
    /// It costs a multiplication, as [`Scalar::divisor`] has already paid for the division.
    fn divided_by(self, divisor: Self::Divisor) -> Self;
    /// (sin x, cos x), x in radians.
    fn sin_cos(self) -> (Self, Self);
    /// The angle of the point (`other`, `self`) in −π..=π: `y.atan2(x)`.
    fn atan2(self, other: Self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// ln x; −∞ or the lower rail for zero, NaN or the lower rail for a negative number.
    fn ln(self) -> Self;

    /// A bound on the error of `count` roundings in a result no larger than `self`.
    ///
    /// A rounding of floats errs by at most ε·|x|, including the last bits of the operands. In fixed point
    /// it errs by half a unit in the last place, and so does the other factor of a product, whose error counts
    /// |x| times.
    fn rounding(self, count: u16) -> Self;

    /// An empty sum of products.
    fn accumulator() -> Self::Accumulator;
    /// `sum + a · b`, exact in fixed point.
    fn mac(sum: Self::Accumulator, a: Self, b: Self) -> Self::Accumulator;
    /// The sum as a value, rounded once and saturating.
    fn finish(sum: Self::Accumulator) -> Self;

    /// Number of bits by which coefficients can be scaled up, if their magnitudes add up to less than 2^exponent, for
    /// use with [`Scalar::advanced`].
    ///
    /// Scaled sums of products keep more digits than `Self` has. In fixed point it is as many bits as fit: the sum
    /// cannot saturate then, whatever the other factors. It is 0 for floats, and `None` if the coefficients do not even
    /// fit unscaled.
    fn headroom(exponent: i32) -> Option<u32>;
    /// [`Scalar::mac`] for coefficients scaled by [`Scalar::headroom`], whose sum cannot overflow: without a check,
    /// fixed point would wrap around beyond. It takes a third of the instructions on a Cortex-M4.
    #[inline(always)]
    fn mac_within(sum: Self::Accumulator, a: Self, b: Self) -> Self::Accumulator {
        Self::mac(sum, a, b)
    }
    /// `self + sum · 2^−shift`, rounded once and saturating, and the remainder of the sum after rounding.
    ///
    /// Starting the next sum with the remainder lets steps below the last place add up. The shift is a
    /// [`Scalar::headroom`] (floats ignore it).
    fn advanced(self, sum: Self::Accumulator, shift: u32) -> (Self, Self::Accumulator);

    /// Σ aᵢ·bᵢ with one rounding in fixed point.
    #[inline]
    fn dot<const N: usize>(a: &[Self; N], b: &[Self; N]) -> Self {
        let mut sum = Self::accumulator();
        for (&a, &b) in a.iter().zip(b) {
            sum = Self::mac(sum, a, b);
        }
        Self::finish(sum)
    }
}
