//! Arithmetic that rounds to nearest, saturates and never panics.

use super::Fixed;
use super::wide::product;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};

impl<const FRAC: u32> Add for Fixed<FRAC> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl<const FRAC: u32> Sub for Fixed<FRAC> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

impl<const FRAC: u32> Neg for Fixed<FRAC> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.saturating_neg())
    }
}

impl<const FRAC: u32> Mul for Fixed<FRAC> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::narrowed(product(self.0, other.0))
    }
}

impl<const FRAC: u32> Div for Fixed<FRAC> {
    type Output = Self;
    /// Rounds half away from zero. Division by zero gives the rail of the dividend's sign, and the lower one for 0/0.
    #[inline]
    fn div(self, divisor: Self) -> Self {
        self.quotient(divisor)
    }
}

macro_rules! impl_assign {
    ($($assign:ident $method:ident $operator:tt),*) => {$(
        impl<const FRAC: u32> $assign for Fixed<FRAC> {
            #[inline]
            fn $method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )*};
}
impl_assign!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /);

impl<const FRAC: u32> Zero for Fixed<FRAC> {
    #[inline]
    fn zero() -> Self {
        Self(0)
    }
    #[inline]
    fn is_zero(&self) -> bool {
        self.0 == 0
    }
}

impl<const FRAC: u32> One for Fixed<FRAC> {
    #[inline]
    fn one() -> Self {
        Self(Self::SCALE)
    }
}
