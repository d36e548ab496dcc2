//! Values on a target: black boxes, which the optimiser takes for any value of the type.

use core::fmt::Debug;
use core::hint::black_box;

use kestirim_scalar::Scalar;

use super::Whole;

/// Whether what takes any numbers is called with `f32`, too, and what has any size with a second one: not in the short form.
/// Fixed point, whose operations are functions with checks of their own, stands for both there.
pub const LONG_FORM: bool = match option_env!("KESTIRIM_SHORT") {
    Some(short) => !matches!(short.as_bytes(), b"1"),
    None => true,
};

/// An arbitrary number.
#[inline(always)]
pub fn number<T: Scalar>() -> T {
    black_box(T::ONE)
}

/// An arbitrary integer.
#[inline(always)]
pub fn whole<I: Whole>() -> I {
    black_box(I::of_bits(1))
}

/// The number of times that a step is taken.
#[inline(always)]
pub fn rounds() -> u32 {
    black_box(1)
}

/// An arbitrary one of the choices.
#[inline(always)]
pub fn one_of<T: Copy, const N: usize>(choices: [T; N]) -> T {
    let [first, ..] = choices.as_slice() else { loop {} };
    black_box(*first)
}

/// The value, or `None`.
#[inline(always)]
pub fn maybe<T>(value: T) -> Option<T> {
    black_box(Some(value))
}

/// A slice of arbitrary length.
#[inline(always)]
pub fn slice<T>(values: &[T]) -> &[T] {
    black_box(values)
}

/// A slice of arbitrary length.
#[inline(always)]
pub fn slice_mut<T>(values: &mut [T]) -> &mut [T] {
    black_box(values)
}

/// Takes a step that may be refused.
#[inline(always)]
pub fn try_on<S: Debug, R, E: Debug>(state: &mut S, step: impl FnOnce(&mut S) -> Result<R, E>) {
    drop(black_box(step(black_box(state))));
}
