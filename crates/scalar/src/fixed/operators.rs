//! The operators.

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

impl<const FRAC: u32> Mul for Fixed<FRAC> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::narrowed(product(self.0, other.0))
    }
}

impl<const FRAC: u32> Div for Fixed<FRAC> {
    type Output = Self;

    #[inline]
    fn div(self, other: Self) -> Self {
        self.quotient(other)
    }
}

impl<const FRAC: u32> Neg for Fixed<FRAC> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(self.0.saturating_neg())
    }
}

macro_rules! assigning {
    ($($operator:ident $method:ident = $symbol:tt;)*) => {$(
        impl<const FRAC: u32> $operator for Fixed<FRAC> {
            #[inline]
            fn $method(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    )*};
}

assigning! {
    AddAssign add_assign = +;
    SubAssign sub_assign = -;
    MulAssign mul_assign = *;
    DivAssign div_assign = /;
}

impl<const FRAC: u32> Zero for Fixed<FRAC> {
    #[inline]
    fn zero() -> Self {
        Self::ZERO
    }

    #[inline]
    fn is_zero(&self) -> bool {
        self.0 == 0
    }
}

impl<const FRAC: u32> One for Fixed<FRAC> {
    #[inline]
    fn one() -> Self {
        Self::ONE
    }
}
