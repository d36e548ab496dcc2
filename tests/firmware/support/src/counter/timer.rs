//! The counter of the MPS2: its first timer, a 32-bit down-counter. (The 24 bits of the SysTick are too few for what
//! takes seconds; QEMU does not emulate the cycle counter of a Cortex-M4, which would be better.)

use core::ptr;

/// Registers of the CMSDK APB timer 0, in the application note's memory map.
const CONTROL: usize = 0x4000_0000;
const VALUE: usize = CONTROL + 0x4;
const RELOAD: usize = CONTROL + 0x8;
const INTERRUPT: usize = CONTROL + 0xC;

/// Starts the timer, and lets its interrupt register record that zero was reached. (The processor is not interrupted:
/// its controller keeps the timer's line masked.)
const RUN: u32 = 1 | 1 << 3;

/// Instructions = ticks · `FACTOR` / 2^`SHIFT`: 40 ns per tick, 256 ns per instruction.
const FACTOR: u64 = 5;
const SHIFT: u32 = 5;

/// The running timer.
pub(crate) struct Counter {
    start: u32,
}

impl Counter {
    /// Starts the timer.
    pub(crate) fn new() -> Self {
        write(RELOAD, u32::MAX);
        write(VALUE, u32::MAX);
        write(CONTROL, RUN);
        Self { start: 0 }
    }

    /// Starts counting.
    #[inline(always)]
    pub(crate) fn start(&mut self) {
        // The whole range is available.
        write(VALUE, u32::MAX);
        write(INTERRUPT, 1);
        self.start = read(VALUE);
    }

    /// Instructions since [`Counter::start`]; `None` above 671 million.
    #[inline(always)]
    pub(crate) fn elapsed(&mut self) -> Option<u32> {
        let end = read(VALUE);
        let ticks = u64::from(self.start.wrapping_sub(end));
        (read(INTERRUPT) == 0).then_some(((ticks * FACTOR + (1 << (SHIFT - 1))) >> SHIFT) as u32)
    }
}

#[inline(always)]
fn read(register: usize) -> u32 {
    #[allow(unsafe_code)] // A register of the board, which nothing else in an image uses.
    unsafe {
        ptr::read_volatile(ptr::with_exposed_provenance(register))
    }
}

#[inline(always)]
fn write(register: usize, value: u32) {
    #[allow(unsafe_code)] // As above.
    unsafe {
        ptr::write_volatile(ptr::with_exposed_provenance_mut(register), value);
    }
}
