//! Conversion of random integers to scalars.

use kestirim_scalar::Scalar;
use rand_core::Rng;

/// Uniform in 0 ≤ u < 1 with 24 bits (rounded to the resolution of the format).
#[inline(always)]
pub(crate) fn uniform<T: Scalar>(bits: u32) -> T {
    T::from_binary((bits >> 8) as i32, -24)
}

/// Nearly normal: zero mean, variance one to six digits, never beyond ±3.
///
/// The sum of three uniform numbers of ten bits. The shape of a kernel matters little, but its cost does: one
/// random word per coordinate and no transcendental function.
#[inline(always)]
pub(crate) fn nearly_normal<T: Scalar>(bits: u32) -> T {
    let sum = (bits & 1023) + ((bits >> 10) & 1023) + ((bits >> 20) & 1023);
    T::from_binary(2 * sum as i32 - 3069, -10)
}

/// A point of D nearly normal coordinates.
#[inline(always)]
pub(crate) fn normal_point<T: Scalar, const D: usize, R: Rng + ?Sized>(rng: &mut R) -> [T; D] {
    let mut point = [T::ZERO; D];
    for coordinate in &mut point {
        *coordinate = nearly_normal(rng.next_u32());
    }
    point
}
