//! Numbers side by side, which a processor with vectors computes at the same time.

use core::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

use kestirim_scalar::Scalar;

/// A number for each of W lanes; all operations are lane by lane.
#[derive(Clone, Copy)]
pub(super) struct Lanes<T, const W: usize>(pub(super) [T; W]);

impl<T: Scalar, const W: usize> Lanes<T, W> {
    /// The same number in all lanes.
    #[inline(always)]
    pub(super) fn all(value: T) -> Self {
        Self([value; W])
    }

    #[inline(always)]
    pub(super) fn map(self, of: impl Fn(T) -> T) -> Self {
        let mut values = self.0;
        for value in &mut values {
            *value = of(*value);
        }
        Self(values)
    }

    #[inline(always)]
    pub(super) fn zip(self, other: Self, of: impl Fn(T, T) -> T) -> Self {
        // A copy: what is written cannot be what is still to be read, so that all lanes are read at once.
        let mut values = self.0;
        for (value, other) in values.iter_mut().zip(other.0) {
            *value = of(*value, other);
        }
        Self(values)
    }
}

impl<T: Scalar, const W: usize> Add for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |one, other| one + other)
    }
}

impl<T: Scalar, const W: usize> AddAssign for Lanes<T, W> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Scalar, const W: usize> Sub for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |one, other| one - other)
    }
}

impl<T: Scalar, const W: usize> SubAssign for Lanes<T, W> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Scalar, const W: usize> Mul for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |one, other| one * other)
    }
}

impl<T: Scalar, const W: usize> Mul<T> for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: T) -> Self {
        self.map(|one| one * other)
    }
}

impl<T: Scalar, const W: usize> Div for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |one, other| one / other)
    }
}
