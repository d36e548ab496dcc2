//! Arguments for the calls: unknown to the optimiser on a target, drawn at random on the host.

#[cfg(not(target_os = "none"))]
mod drawn;
#[cfg(target_os = "none")]
mod opaque;

use core::hint::black_box;

use kestirim_scalar::Scalar;
use nalgebra::SMatrix;
use rand_core::{Infallible, TryRng};

#[cfg(not(target_os = "none"))]
pub use drawn::{
    LONG_FORM, maybe, number, one_of, rounds, slice, slice_mut, start_from, try_on, whole,
};
#[cfg(target_os = "none")]
pub use opaque::{LONG_FORM, maybe, number, one_of, rounds, slice, slice_mut, try_on, whole};

/// The value, hidden from the optimiser.
#[inline(always)]
pub fn any<T>(value: T) -> T {
    black_box(value)
}

/// Uses a whole result, so that none of it is optimised away.
#[inline(always)]
pub fn keep<T>(result: T) {
    black_box(result);
}

/// Calls functions one by one; none is inlined here or left out.
#[inline(always)]
pub fn call_each<const N: usize>(functions: [fn(); N]) {
    for function in black_box(functions) {
        function();
    }
}

/// Arbitrary numbers.
#[inline(always)]
pub fn numbers<T: Scalar, const N: usize>() -> [T; N] {
    black_box([(); N].map(|()| number()))
}

/// An arbitrary matrix or vector.
#[inline(always)]
pub fn matrix<T: Scalar, const R: usize, const C: usize>() -> SMatrix<T, R, C> {
    black_box(SMatrix::from([(); C].map(|()| numbers())))
}

/// An arbitrary number, or `None`.
#[inline(always)]
pub fn option<T: Scalar>() -> Option<T> {
    maybe(number())
}

/// An arbitrary truth value.
#[inline(always)]
pub fn yes_or_no() -> bool {
    one_of([true, false])
}

/// An integer type.
pub trait Whole: Copy {
    /// The integer with these low bits.
    fn of_bits(bits: u64) -> Self;
}

macro_rules! impl_whole {
    ($($whole:ty),*) => {$(
        impl Whole for $whole {
            #[inline(always)]
            fn of_bits(bits: u64) -> Self {
                bits as Self
            }
        }
    )*};
}
impl_whole!(u8, u16, u32, u64, usize, i8, i32);

/// A generator of arbitrary random numbers.
pub struct AnyRng;

impl TryRng for AnyRng {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(whole())
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(whole())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        bytes.fill(whole());
        Ok(())
    }
}
