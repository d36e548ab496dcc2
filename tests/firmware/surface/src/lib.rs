//! What the binaries share: values that the optimiser knows nothing of.
//!
//! A binary in `src/bin` calls everything that one crate offers, each function by its path
//! (`Gaussian::update(&mut estimate, …)`), so that `tests/tests/panic_free.rs` can compare what is
//! called with what is public. No binary is ever run: what counts is what it links. `Debug` and `Display` are
//! left out: `core::fmt` has panics of its own.

#![no_std]

use core::hint::black_box;
use core::panic::PanicInfo;

use kestirim_scalar::Scalar;
use nalgebra::SMatrix;
use rand_core::{Infallible, TryRng};

/// Makes a program of `$run`, a `fn()`.
#[macro_export]
macro_rules! image {
    ($run:path) => {
        #[allow(unsafe_code)] // The symbol is claimed once: a program has one `main`.
        #[unsafe(export_name = "main")]
        extern "C" fn main() {
            $run();
        }
    };
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    loop {}
}

/// A value, of which the optimiser forgets whatever it knew.
#[inline(always)]
pub fn any<T>(value: T) -> T {
    black_box(value)
}

/// Uses a result, all of it.
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

/// Any number.
#[inline(always)]
pub fn number<T: Scalar>() -> T {
    black_box(T::ONE)
}

/// Any numbers.
#[inline(always)]
pub fn numbers<T: Scalar, const N: usize>() -> [T; N] {
    black_box([T::ONE; N])
}

/// Any number, or none.
#[inline(always)]
pub fn option<T: Scalar>() -> Option<T> {
    black_box(Some(T::ONE))
}

/// Any matrix or vector.
#[inline(always)]
pub fn matrix<T: Scalar, const R: usize, const C: usize>() -> SMatrix<T, R, C> {
    black_box(SMatrix::from([[T::ONE; R]; C]))
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

/// Any random numbers.
pub struct AnyRng;

impl TryRng for AnyRng {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(black_box(0))
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(black_box(0))
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        bytes.fill(black_box(0));
        Ok(())
    }
}
