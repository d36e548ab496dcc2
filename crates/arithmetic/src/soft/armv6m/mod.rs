//! Single precision for Cortex-M0 and M0+, which have no floating-point unit: the routines of Arm's run-time ABI that
//! compilers call for it. Numbers of everyday size are handled in assembler, all others by [`every_case`].
//!
//! The symbols are weak, like the compiler's own, which come after these in link order. Strong symbols of the same
//! names from elsewhere, such as those in a chip's ROM, take precedence.

use super::every_case;

extern "C" fn add(a: u32, b: u32) -> u32 {
    every_case::add(a, b)
}

extern "C" fn multiply(a: u32, b: u32) -> u32 {
    every_case::multiply(a, b)
}

extern "C" fn divide(a: u32, b: u32) -> u32 {
    every_case::divide(a, b)
}

#[allow(unsafe_code)] // Defines symbols that compilers call; needs carries, which Rust lacks.
mod routines {
    // SAFETY: the routines keep to the procedure call standard: they change r0 to r3, r12 and the flags alone, and leave the
    // stack as it was; every branch stays within its file or calls a function of that standard. The compiler's routines
    // of these names compute the same.
    core::arch::global_asm!(include_str!("add.s"), every_case = sym super::add);
    core::arch::global_asm!(include_str!("multiply.s"), every_case = sym super::multiply);
    core::arch::global_asm!(include_str!("divide.s"), every_case = sym super::divide);
    core::arch::global_asm!(include_str!("compare.s"));
}
