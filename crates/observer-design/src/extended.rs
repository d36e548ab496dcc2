//! Numbers of 106 bits.
//!
//! Placing poles that lie close together, or observing a state through three integrations of a millisecond each,
//! costs more digits than a double has. The design therefore computes with unevaluated sums of two doubles and
//! rounds its result once. `twofloat` 0.8.4 would serve, except that its quotients are only accurate to 54 bits
//! (1/3 · 3 − 1 = −5.6e-17) and that it multiplies by `fma`, which is slow software on most targets.
//!
//! The algorithms are those of Joldes, Muller & Popescu, "Tight and rigorous error bounds for basic building
//! blocks of double-word arithmetic", ACM TOMS 44 (2017). Sums, products and quotients are not inlined, which
//! saves a fifth of the flash on targets without doubles for two per cent more instructions.

use core::ops::{
    Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Rem, RemAssign, Sub, SubAssign,
};
use num_traits::{Num, One, Zero};

/// The number `high + low`, where `low` is at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct Extended {
    high: f64,
    low: f64,
}

/// Relative accuracy of computations: the distance from 1 to the next number that they can distinguish.
pub(crate) const EPSILON: f64 = 2.5e-32;

/// The rounded sum a + b, and its rounding error.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let a_part = sum - b;
    let b_part = sum - a_part;
    (sum, (a - a_part) + (b - b_part))
}

/// [`two_sum`] for |a| ≥ |b|.
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The rounded product a · b, and its rounding error.
///
/// The error is the exact product of the mantissas minus the rounded one, a number so small that the low 64 bits of
/// both determine it. In software double arithmetic, Dekker's splitting is several times the work.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let exponents = exponent(a) + exponent(b);
    if !(a.is_normal() && b.is_normal() && product.is_normal()) || exponents <= LEAST_EXPONENTS {
        return (product, 0.0);
    }
    // The last place of the rounded product, in units of that of the exact one.
    let shift = exponent(product) + 1075 - exponents;
    let exact = mantissa(a).wrapping_mul(mantissa(b));
    let error = exact.wrapping_sub(mantissa(product) << shift) as i64 as f64;
    if error == 0.0 {
        return (product, 0.0);
    }
    let scaled = error.to_bits().wrapping_add((exponents.wrapping_sub(2 * 1075)) << 52);
    (product, f64::from_bits(scaled ^ (product.to_bits() & (1 << 63))))
}

/// Sum of the biased exponents of two factors above which the error of their product is not subnormal.
const LEAST_EXPONENTS: u64 = 2 * 1075 - 1023;

/// The biased exponent of a double.
fn exponent(a: f64) -> u64 {
    a.to_bits() >> 52 & 0x7ff
}

/// The 53-bit mantissa of a normal number.
fn mantissa(a: f64) -> u64 {
    a.to_bits() & ((1 << 52) - 1) | 1 << 52
}

impl Extended {
    /// The nearest double.
    pub(crate) fn to_f64(self) -> f64 {
        self.high
    }

    /// √x; 0 if x is not positive.
    pub(crate) fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::zero();
        }
        let root = Self::from(libm::sqrt(self.high));
        root + (self - root * root) / (root + root)
    }

    fn from_parts((high, low): (f64, f64)) -> Self {
        Self { high, low }
    }

    fn truncated(self) -> Self {
        let high = libm::trunc(self.high);
        let low = if high == self.high { libm::trunc(self.low) } else { 0.0 };
        Self { high, low }
    }
}

impl From<f64> for Extended {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Neg for Extended {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Add for Extended {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        if other.is_zero() {
            return self;
        }
        if self.is_zero() {
            return other;
        }
        let (high, high_error) = two_sum(self.high, other.high);
        let (low, low_error) = two_sum(self.low, other.low);
        let (high, rest) = fast_two_sum(high, high_error + low);
        Self::from_parts(fast_two_sum(high, low_error + rest))
    }
}

impl Sub for Extended {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for Extended {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let (high, error) = two_product(self.high, other.high);
        if high == 0.0 {
            return Self::from(high);
        }
        let cross = self.high * other.low + self.low * other.high;
        Self::from_parts(fast_two_sum(high, error + cross))
    }
}

impl Div for Extended {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        // Long division in base 2⁵³: three digits, two of which are kept.
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::from(second);
        let third = rest.high / other.high;
        Self::from_parts(fast_two_sum(first, second)) + Self::from(third)
    }
}

impl Rem for Extended {
    type Output = Self;
    fn rem(self, other: Self) -> Self {
        self - other * (self / other).truncated()
    }
}

macro_rules! assign {
    ($($trait:ident $method:ident $operator:tt),*) => {$(
        impl $trait for Extended {
            fn $method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )*};
}

assign!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /, RemAssign rem_assign %);

impl Zero for Extended {
    fn zero() -> Self {
        Self::from(0.0)
    }
    fn is_zero(&self) -> bool {
        self.high == 0.0
    }
}

impl One for Extended {
    fn one() -> Self {
        Self::from(1.0)
    }
}

impl Num for Extended {
    type FromStrRadixErr = num_traits::ParseFloatError;
    /// Parses a number with the precision of a double.
    fn from_str_radix(text: &str, radix: u32) -> Result<Self, Self::FromStrRadixErr> {
        <f64 as Num>::from_str_radix(text, radix).map(Self::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn number() -> impl Strategy<Value = Extended> {
        (-1e6_f64..1e6, -1.0_f64..1.0)
            .prop_map(|(high, low)| Extended::from(high) + Extended::from(low * 1e-12))
    }

    proptest! {
        #[test]
        fn a_quotient_times_its_divisor_is_the_dividend(a in number(), b in number()) {
            prop_assume!(b.high.abs() > 1e-3);
            let error = (a / b) * b - a;
            prop_assert!(error.high.abs() <= 8.0 * EPSILON * a.high.abs());
        }

        #[test]
        fn a_product_and_its_error_are_exact(a in -1e60_f64..1e60, b in -1e-30_f64..1e-30) {
            let (product, error) = two_product(a, b);
            prop_assert_eq!(error, libm::fma(a, b, -product));
        }

        #[test]
        fn a_square_has_its_root(a in number()) {
            let root = (a * a).sqrt();
            prop_assert!((root.high - a.high.abs()).abs() <= 8.0 * EPSILON * a.high.abs());
        }

        #[test]
        fn sums_undo_differences(a in number(), b in number()) {
            let error = (a - b) + b - a;
            prop_assert!(error.high.abs() <= 8.0 * EPSILON * (a.high.abs() + b.high.abs()));
        }
    }

    #[test]
    fn a_third_has_106_bits() {
        let third = Extended::one() / Extended::from(3.0);
        assert!((third * Extended::from(3.0) - Extended::one()).high.abs() <= EPSILON);
        assert_eq!((Extended::from(7.5) % Extended::from(2.0)).to_f64(), 1.5);
    }
}
