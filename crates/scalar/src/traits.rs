use core::ops::{Add, Div, Mul, Sub};
use core::ops::{AddAssign, DivAssign, MulAssign, Neg, SubAssign};
use num_traits::{One, Zero};

/// A real number an estimator can be built on: `f32`, `f64` or [`Fixed`](crate::Fixed).
///
/// Everything is total: no operation panics. What a float answers with an infinity or a NaN,
/// fixed point answers with one of its two rails ([`Scalar::MIN`], [`Scalar::MAX`]), and
/// [`Scalar::is_finite`] tells both.
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
    /// A sum of products, wider than `Self`: fixed point rounds once when it is finished.
    type Accumulator: nalgebra::Scalar + Copy;
    /// A divisor prepared once for several quotients, over the whole range of `Self`: the reciprocal
    /// for floats, mantissa and shift for fixed point (whose reciprocal of a small number would
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
    /// π, rounded.
    const PI: Self;
    /// The distance from 1 to the next larger value.
    const EPSILON: Self;
    /// The smallest value: the lower rail.
    const MIN: Self;
    /// The largest value: the upper rail.
    const MAX: Self;
    /// Whether sums and products with what is not finite are not finite either: true of floats; fixed point may leave a rail.
    const SPREADS: bool = false;

    /// The nearest value; out of range saturates. NaN becomes NaN, or the lower rail in fixed point.
    ///
    /// With a constant argument it folds to a constant: no double-precision code reaches the target.
    fn from_f64(value: f64) -> Self;
    /// The exact value (fixed point with up to 31 fractional bits fits a double).
    fn to_f64(self) -> f64;
    /// The nearest value to an `f32`, in single precision only (drivers and logs deliver `f32`).
    fn from_f32(value: f32) -> Self;
    /// The nearest `f32`.
    fn to_f32(self) -> f32;
    /// `value · 10⁻⁶`, rounded once: microseconds to seconds without double precision.
    fn from_micro(value: i32) -> Self;

    /// `value · 2^exponent`, rounded once; −126 ≤ exponent ≤ 127. What integers have computed, such as random
    /// numbers, becomes a scalar.
    fn from_binary(value: i32, exponent: i32) -> Self;
    /// The integer nearest to `self · 2^−exponent`; saturates, and of NaN it is 0 or the lower rail.
    fn to_binary(self, exponent: i32) -> i32;

    /// False for NaN and infinities; for the two rails in fixed point.
    fn is_finite(self) -> bool;

    /// Whether it is finite and more than zero.
    #[inline]
    fn is_positive(self) -> bool {
        self.is_finite() && self > Self::ZERO
    }

    /// Whether all of them are finite.
    #[inline(always)]
    fn all_finite(values: &[Self]) -> bool {
        values.iter().all(|value| value.is_finite())
    }

    /// |x|; saturates.
    fn abs(self) -> Self;
    /// The smaller of two; `self` where either is NaN.
    #[inline]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// The larger of two; `self` where either is NaN.
    #[inline]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
    /// Within `low..=high`; NaN stays NaN.
    #[inline]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }

    /// √x; of a negative number NaN, or the lower rail in fixed point.
    fn sqrt(self) -> Self;
    /// √(x² + y²) without intermediate overflow.
    fn hypot(self, other: Self) -> Self;
    /// √(Σ xᵢ²), for lengths of everyday size: where a square overflows or vanishes, so does the float's
    /// result ([`Scalar::hypot`] is more careful, and slower).
    fn norm<const N: usize>(components: &[Self; N]) -> Self;
    /// The logarithm of that norm, without its square root.
    fn ln_norm<const N: usize>(components: &[Self; N]) -> Self;
    /// 1/x; of zero an infinity, or the upper rail in fixed point.
    fn recip(self) -> Self;
    /// Prepares `self` as the divisor of [`Scalar::divided_by`]; any number will do, zero too.
    fn divisor(self) -> Self::Divisor;
    /// `self / divisor`, rounded within one or two units in the last place; by a zero divisor as `/`.
    /// A multiplication, where the division was paid for once in [`Scalar::divisor`].
    fn divided_by(self, divisor: Self::Divisor) -> Self;
    /// (sin x, cos x), x in radians.
    fn sin_cos(self) -> (Self, Self);
    /// The angle of the point (`other`, `self`) in −π..=π: `y.atan2(x)`.
    fn atan2(self, other: Self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// ln x; of zero −∞ or the lower rail, of a negative number NaN or the lower rail.
    fn ln(self) -> Self;

    /// A bound on the error that `count` roundings leave in a result no larger than `self`.
    ///
    /// A rounding of floats errs by ε·|x| at most, with the operands' own last bits. In fixed point
    /// it errs by half a unit in the last place; so does the other factor of a product, which counts
    /// |x| times.
    fn rounding(self, count: u16) -> Self;

    /// An empty sum of products.
    fn accumulator() -> Self::Accumulator;
    /// `sum + a · b`, exact in fixed point.
    fn mac(sum: Self::Accumulator, a: Self, b: Self) -> Self::Accumulator;
    /// The sum, rounded once; saturates.
    fn finish(sum: Self::Accumulator) -> Self;

    /// By how many bits coefficients can be scaled up whose magnitudes add up to less than 2^exponent, so that
    /// sums of their products keep more digits than `Self` has; for [`Scalar::advanced`]. In fixed point as many as
    /// fit: the sum cannot saturate then, whatever the other factors. For floats 0. `None` if the coefficients
    /// do not fit as they are.
    fn headroom(exponent: i32) -> Option<u32>;
    /// [`Scalar::mac`] for coefficients scaled by [`Scalar::headroom`], whose sum needs no watching: beyond it, fixed
    /// point wraps around. A third of the instructions on a Cortex-M4.
    #[inline(always)]
    fn mac_within(sum: Self::Accumulator, a: Self, b: Self) -> Self::Accumulator {
        Self::mac(sum, a, b)
    }
    /// `self + sum · 2^−shift`, rounded once and saturating, and what the rounding has left of the sum: the next sum
    /// begins with it, so that steps below the last place add up. The shift is a [`Scalar::headroom`] (floats
    /// ignore it).
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
