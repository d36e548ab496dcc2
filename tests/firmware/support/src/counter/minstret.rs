//! The counter of RISC-V: the register `minstret`, which under `-icount` holds the virtual time in ns.

use riscv::register::minstret;

/// `minstret` grows by 2^`SHIFT` per instruction.
const SHIFT: u32 = 8;

/// The running instruction counter.
pub(crate) struct Counter {
    start: u64,
}

impl Counter {
    /// A counter; the register runs from reset on.
    pub(crate) fn new() -> Self {
        Self { start: 0 }
    }

    /// Starts counting.
    #[inline(always)]
    pub(crate) fn start(&mut self) {
        self.start = minstret::read64();
    }

    /// Instructions since [`Counter::start`]; `None` above 4.29 thousand million.
    #[inline(always)]
    pub(crate) fn elapsed(&mut self) -> Option<u32> {
        u32::try_from((minstret::read64() - self.start) >> SHIFT).ok()
    }
}
