//! Code of known cost, with which the meter is checked.

use core::arch::asm;
use core::hint::black_box;

/// Executes exactly one thousand instructions.
#[inline(always)]
pub fn thousand_nops() {
    #[allow(unsafe_code)] // Does nothing.
    unsafe {
        asm!(".rept 1000", "nop", ".endr", options(nomem, nostack, preserves_flags));
    }
}

/// Executes exactly `2 · turns` instructions and those that load `turns`; `turns` must not be 0.
#[inline(always)]
pub fn spin(turns: u32) {
    #[allow(unsafe_code)] // Counts a register down.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("2:", "subs {0}, {0}, #1", "bne 2b", inout(reg) turns => _, options(nomem, nostack));
        #[cfg(target_arch = "riscv32")]
        asm!("2:", "addi {0}, {0}, -1", "bnez {0}, 2b", inout(reg) turns => _, options(nomem, nostack));
    }
}

/// Uses `BYTES` of stack and a little more.
#[inline(never)]
pub fn use_stack<const BYTES: usize>() {
    let mut bytes = [0_u8; BYTES];
    black_box(&mut bytes);
}
