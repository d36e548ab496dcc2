//! A double-precision number whose operations are counted, so that cost is a count instead of a
//! time.

use kestirim_scalar::Scalar;
use num_traits::{One, Zero};
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

thread_local!(static OPERATIONS: Cell<u64> = const { Cell::new(0) });

/// The number of operations of this thread while `work` runs.
pub(crate) fn operations(work: impl FnOnce()) -> u64 {
    let before = OPERATIONS.get();
    work();
    OPERATIONS.get() - before
}

fn count(value: f64) -> Counted {
    OPERATIONS.set(OPERATIONS.get() + 1);
    Counted(value)
}

/// A double-precision number that counts its operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub(crate) struct Counted(f64);

macro_rules! operators {
    ($($operator:ident $call:ident $assign:ident $in_place:ident,)*) => {$(
        impl $operator for Counted {
            type Output = Self;
            fn $call(self, other: Self) -> Self {
                count(self.0.$call(other.0))
            }
        }
        impl $assign for Counted {
            fn $in_place(&mut self, other: Self) {
                *self = self.$call(other);
            }
        }
    )*};
}
operators! {
    Add add AddAssign add_assign,
    Sub sub SubAssign sub_assign,
    Mul mul MulAssign mul_assign,
    Div div DivAssign div_assign,
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Zero for Counted {
    fn zero() -> Self {
        Self(0.0)
    }
    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for Counted {
    fn one() -> Self {
        Self(1.0)
    }
}

impl Scalar for Counted {
    type Accumulator = Self;
    type Divisor = Self;
    const ZERO: Self = Self(0.0);
    const ONE: Self = Self(1.0);
    const HALF: Self = Self(0.5);
    const TWO: Self = Self(2.0);
    const PI: Self = Self(std::f64::consts::PI);
    const EPSILON: Self = Self(f64::EPSILON);
    const IS_FLOAT: bool = true;
    const MIN: Self = Self(f64::MIN);
    const MAX: Self = Self(f64::MAX);
    const MAX_WHOLE: u32 = u32::MAX;

    fn from_f64(value: f64) -> Self {
        Self(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn from_f32(value: f32) -> Self {
        Self(value.into())
    }
    fn to_f32(self) -> f32 {
        self.0 as f32
    }
    fn from_micro(value: i32) -> Self {
        Self(f64::from(value) * 1e-6)
    }
    fn from_binary(value: i32, exponent: i32) -> Self {
        Self(f64::from(value) * f64::powi(2.0, exponent))
    }
    fn to_binary(self, exponent: i32) -> i32 {
        (self.0 * f64::powi(2.0, -exponent)).round() as i32
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn sqrt(self) -> Self {
        count(self.0.sqrt())
    }
    fn hypot(self, other: Self) -> Self {
        count(self.0.hypot(other.0))
    }
    fn norm<const N: usize>(components: &[Self; N]) -> Self {
        Self::dot(components, components).sqrt()
    }
    fn ln_norm<const N: usize>(components: &[Self; N]) -> Self {
        Self::norm(components).ln()
    }
    fn recip(self) -> Self {
        count(self.0.recip())
    }
    fn divisor(self) -> Self {
        self.recip()
    }
    fn divided_by(self, divisor: Self) -> Self {
        self * divisor
    }
    fn sin_cos(self) -> (Self, Self) {
        (count(self.0.sin()), count(self.0.cos()))
    }
    fn atan2(self, other: Self) -> Self {
        count(self.0.atan2(other.0))
    }
    fn exp(self) -> Self {
        count(self.0.exp())
    }
    fn ln(self) -> Self {
        count(self.0.ln())
    }
    fn rounding(self, times: u16) -> Self {
        count(self.0.abs() * f64::EPSILON * f64::from(times))
    }
    fn accumulator() -> Self {
        Self(-0.0)
    }
    fn mac(sum: Self, a: Self, b: Self) -> Self {
        sum + a * b
    }
    fn finish(sum: Self) -> Self {
        sum
    }
    fn headroom(_: i32) -> Option<u32> {
        Some(0)
    }
    fn advanced(self, sum: Self, _: u32) -> (Self, Self) {
        (self + sum, Self::ZERO)
    }
}
