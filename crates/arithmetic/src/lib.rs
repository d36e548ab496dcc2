#![no_std]
// Such a crate stays out of link-time optimisation, in which weak symbols and those of the same names that are not would
// meet in one object, where they are an error.
#![cfg_attr(all(feature = "soft-float", armv6m), no_builtins)]
#![doc = include_str!("../README.md")]

#[cfg(all(feature = "vectors", target_arch = "x86_64"))]
extern crate std;

#[cfg(any(test, all(feature = "soft-float", armv6m)))]
mod soft;
pub mod vectors;

/// √x, rounded to the nearest number; of zero that zero, of what is below it NaN (IEEE 754).
#[inline(always)] // A kernel for vectors must not be left for it.
pub fn sqrt(x: f32) -> f32 {
    of_processor(x)
}

/// `core::f32::math::sqrt` is not stable, and `f32::sqrt` is std's.
#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
#[inline(always)]
#[allow(unsafe_code)] // An instruction that no function of `core` stands for.
fn of_processor(x: f32) -> f32 {
    let mut bits = x.to_bits();
    // By way of a general register: rustc lets nobody name one of the unit's where it has no double precision.
    // SAFETY: the instructions touch one register of each kind, both named; this ABI is for processors that have them.
    unsafe {
        core::arch::asm!("vmov s0, {bits}", "vsqrt.f32 s0, s0", "vmov {bits}, s0",
            bits = inout(reg) bits, out("s0") _, options(pure, nomem, nostack));
    }
    f32::from_bits(bits)
}

/// Intrinsics, not libm's assembler: a loop over them becomes vector instructions.
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
#[inline(always)]
#[allow(unsafe_code)] // As above.
fn of_processor(x: f32) -> f32 {
    use core::arch::x86_64::{_mm_cvtss_f32, _mm_set_ss, _mm_sqrt_ss};
    // SAFETY: compiled only for processors that have SSE.
    unsafe { _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(x))) }
}

#[cfg(all(feature = "soft-float", armv6m))]
use soft::sqrt as of_processor;

#[cfg(not(any(
    all(target_arch = "x86_64", target_feature = "sse2"),
    all(target_arch = "arm", target_abi = "eabihf"),
    all(feature = "soft-float", armv6m)
)))]
#[inline(always)]
fn of_processor(x: f32) -> f32 {
    libm::sqrtf(x)
}
