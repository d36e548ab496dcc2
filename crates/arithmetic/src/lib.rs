#![no_std]
// A `no_builtins` crate stays out of link-time optimisation, which would merge its weak symbols with strong ones of the
// same names into one object, and fail.
#![cfg_attr(all(feature = "soft-float", armv6m), no_builtins)]
#![doc = include_str!("../README.md")]

#[cfg(all(feature = "vectors", target_arch = "x86_64"))]
extern crate std;

#[cfg(any(test, all(feature = "soft-float", armv6m)))]
mod soft;
pub mod vectors;

/// √x, rounded to the nearest number; −0 for −0, and NaN below zero (IEEE 754).
#[inline(always)] // Vector kernels must not contain a call.
pub fn sqrt(x: f32) -> f32 {
    of_processor(x)
}

/// √x in double precision, as [`sqrt`] in single.
///
/// On x86-64 by intrinsics instead of libm's assembler, which keeps the compiler from making vectors of a loop, and is encoded for
/// processors without AVX: between instructions for AVX it waits for the upper halves of its registers.
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
#[inline(always)]
#[allow(unsafe_code)] // No stable function of `core` gives this instruction.
pub fn sqrt_f64(x: f64) -> f64 {
    use core::arch::x86_64::{_mm_cvtsd_f64, _mm_set_sd, _mm_sqrt_sd};
    // SAFETY: compiled only for processors that have SSE2.
    unsafe { _mm_cvtsd_f64(_mm_sqrt_sd(_mm_set_sd(x), _mm_set_sd(x))) }
}

/// √x in double precision, as [`sqrt`] in single.
#[cfg(not(all(target_arch = "x86_64", target_feature = "sse2")))]
#[inline(always)]
pub fn sqrt_f64(x: f64) -> f64 {
    libm::sqrt(x)
}

/// The root by an instruction: `core::f32::math::sqrt` is unstable, and `f32::sqrt` needs std.
#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
#[inline(always)]
#[allow(unsafe_code)] // No stable function of `core` gives this instruction.
fn of_processor(x: f32) -> f32 {
    let mut bits = x.to_bits();
    // Passed in a general register: without double precision, rustc accepts no floating-point register as an operand.
    // SAFETY: the instructions touch one register of each kind, both named; this ABI is for processors that have them.
    unsafe {
        core::arch::asm!("vmov s0, {bits}", "vsqrt.f32 s0, s0", "vmov {bits}, s0",
            bits = inout(reg) bits, out("s0") _, options(pure, nomem, nostack));
    }
    f32::from_bits(bits)
}

/// The root by intrinsics instead of libm's assembler, so that a loop over it is vectorised.
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
#[inline(always)]
#[allow(unsafe_code)] // No stable function of `core` gives this instruction.
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
