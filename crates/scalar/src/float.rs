//! The trait for floats: arithmetic is the machine's, functions are libm's or this crate's own, so that host and
//! target agree bit for bit.

use crate::{Scalar, double, single};

/// 2^exponent for −126 ≤ exponent ≤ 127; exponents beyond are clamped.
#[inline(always)]
fn power_of_two(exponent: i32) -> f32 {
    f32::from_bits(((exponent.clamp(-126, 127) + 127) as u32) << 23)
}

/// Whether the processor is likely to have this arithmetic itself; chooses between code that is correct either way.
const HAS_SINGLE: bool = HAS_DOUBLE || cfg!(target_abi = "eabihf");
const HAS_DOUBLE: bool = cfg!(not(any(target_arch = "arm", target_arch = "riscv32")));

macro_rules! impl_scalar_for_float {
    ($float:ident, $has_unit:expr, $sqrt:path, $root:path, $hypot:path, $sin_cos:path, $atan2:path, $exp:path, $ln:path) => {
        impl Scalar for $float {
            type Accumulator = $float;
            type Divisor = $float;

            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const TWO: Self = 2.0;
            const PI: Self = core::$float::consts::PI;
            const EPSILON: Self = $float::EPSILON;
            const MIN: Self = $float::MIN;
            const MAX: Self = $float::MAX;
            const MAX_WHOLE: u32 = match 1_u32.checked_shl($float::MANTISSA_DIGITS) {
                Some(whole) => whole,
                None => u32::MAX,
            };
            const IS_FLOAT: bool = true;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as Self
            }
            #[inline]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline]
            fn from_f32(value: f32) -> Self {
                value as Self
            }
            #[inline]
            fn to_f32(self) -> f32 {
                self as f32
            }
            #[inline]
            fn from_micro(value: i32) -> Self {
                value as Self * 1e-6
            }

            #[inline]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
            #[inline]
            fn is_positive(self) -> bool {
                // The bits of positive finite numbers lie between those of zero and infinity, so one comparison
                // suffices.
                self.to_bits().wrapping_sub(1) < $float::INFINITY.to_bits() - 1
            }
            #[inline(always)]
            fn all_finite(values: &[Self]) -> bool {
                if $has_unit {
                    // Zero times a number that is not finite is NaN, so one sum and one comparison check all. −0 + x is
                    // x, which saves an addition.
                    values.iter().fold(-0.0, |sum: $float, value| sum + value * 0.0) == 0.0
                } else {
                    values.iter().all(|value| value.is_finite())
                }
            }
            #[inline]
            fn abs(self) -> Self {
                $float::abs(self)
            }
            #[inline]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline]
            fn hypot(self, other: Self) -> Self {
                $hypot(self, other)
            }
            #[inline]
            fn norm<const N: usize>(components: &[Self; N]) -> Self {
                $root(Self::dot(components, components))
            }
            #[inline(always)]
            fn ln_norm<const N: usize>(components: &[Self; N]) -> Self {
                $ln(Self::dot(components, components)) * 0.5
            }
            #[inline]
            fn recip(self) -> Self {
                $float::recip(self)
            }
            #[inline]
            fn divisor(self) -> Self {
                self.recip()
            }
            #[inline]
            fn divided_by(self, divisor: Self) -> Self {
                self * divisor
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                $sin_cos(self)
            }
            #[inline]
            fn atan2(self, other: Self) -> Self {
                $atan2(self, other)
            }
            #[inline]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline]
            fn ln(self) -> Self {
                $ln(self)
            }

            #[inline(always)]
            fn from_binary(value: i32, exponent: i32) -> Self {
                value as Self * power_of_two(exponent) as Self
            }
            #[inline(always)]
            fn to_binary(self, exponent: i32) -> i32 {
                let scaled = self * power_of_two(-exponent) as Self;
                (if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i32
            }

            #[inline]
            fn rounding(self, count: u16) -> Self {
                $float::abs(self) * ($float::EPSILON * count as $float)
            }
            #[inline]
            fn accumulator() -> Self {
                // −0 + x is x to the bit, so that the compiler drops the addition.
                -0.0
            }
            #[inline]
            fn mac(sum: Self, a: Self, b: Self) -> Self {
                sum + a * b
            }
            #[inline]
            fn finish(sum: Self) -> Self {
                sum
            }

            #[inline]
            fn headroom(exponent: i32) -> Option<u32> {
                (exponent <= $float::MAX_EXP).then_some(0)
            }
            #[inline(always)]
            fn advanced(self, sum: Self, _shift: u32) -> (Self, Self) {
                let next = self + sum;
                (next, sum - (next - self))
            }
        }
    };
}

// libm's single-precision sine and hypotenuse compute in double precision, which a target without
// it emulates at ten times the cost; its exponential, logarithm and arc tangent branch, so that a loop over
// a thousand particles is not vectorised. This crate's own functions replace them.
impl_scalar_for_float!(
    f32,
    HAS_SINGLE,
    kestirim_arithmetic::sqrt,
    kestirim_arithmetic::sqrt,
    single::hypot,
    single::sin_cos,
    single::atan2,
    single::exp,
    single::ln
);
impl_scalar_for_float!(
    f64,
    HAS_DOUBLE,
    kestirim_arithmetic::sqrt_f64,
    double::root,
    libm::hypot,
    libm::sincos,
    double::atan2,
    double::exp,
    double::ln
);
