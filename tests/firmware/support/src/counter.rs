//! Counts executed instructions exactly.
//!
//! Under QEMU's `-icount shift=8` every instruction takes 2⁸ = 256 ns of virtual time, so a clock counts instructions.
//! The shift is that large because the clock then ticks 4.096 times (at 16 MHz) or 6.4 times (at 25 MHz) per
//! instruction: rounding the ticks to instructions is then unambiguous, while at one tick per instruction every count
//! would be uncertain by one. The host's `target.rs` holds the same shift.

#[cfg(target_arch = "riscv32")]
mod minstret;
#[cfg(board = "microbit")]
mod systick;
#[cfg(board = "mps2-an386")]
mod timer;

#[cfg(target_arch = "riscv32")]
pub(crate) use minstret::Counter;
#[cfg(board = "microbit")]
pub(crate) use systick::Counter;
#[cfg(board = "mps2-an386")]
pub(crate) use timer::Counter;
