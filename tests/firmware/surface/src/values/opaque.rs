//! On a target: the optimiser takes a black box for any value of the type.

use core::fmt::Debug;
use core::hint::black_box;

use kestirim_scalar::Scalar;

use super::Whole;

/// Any number.
#[inline(always)]
pub fn number<T: Scalar>() -> T {
    black_box(T::ONE)
}

/// Any whole number.
#[inline(always)]
pub fn whole<I: Whole>() -> I {
    black_box(I::of_bits(1))
}

/// How often a step is taken.
#[inline(always)]
pub fn rounds() -> u32 {
    black_box(1)
}

/// Any of them.
#[inline(always)]
pub fn one_of<T: Copy, const N: usize>(choices: [T; N]) -> T {
    let [first, ..] = choices.as_slice() else { loop {} };
    black_box(*first)
}

/// It, or none.
#[inline(always)]
pub fn maybe<T>(value: T) -> Option<T> {
    black_box(Some(value))
}

/// A slice of any length.
#[inline(always)]
pub fn slice<T>(values: &[T]) -> &[T] {
    black_box(values)
}

/// A slice of any length.
#[inline(always)]
pub fn slice_mut<T>(values: &mut [T]) -> &mut [T] {
    black_box(values)
}

/// A step that may be refused.
#[inline(always)]
pub fn try_on<S: Debug, R, E: Debug>(state: &mut S, step: impl FnOnce(&mut S) -> Result<R, E>) {
    drop(black_box(step(black_box(state))));
}
