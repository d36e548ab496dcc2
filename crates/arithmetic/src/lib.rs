#![no_std]
#![doc = include_str!("../README.md")]

/// √x, rounded to the nearest number; of zero that zero, of what is below it NaN (IEEE 754).
#[inline]
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

#[cfg(not(all(target_arch = "arm", target_abi = "eabihf")))]
#[inline(always)]
fn of_processor(x: f32) -> f32 {
    libm::sqrtf(x)
}
