//! The counter of any Cortex-M: the SysTick, a 24-bit down-counter.

use cortex_m::peripheral::{SYST, syst::SystClkSource};

const FULL: u32 = 0x00FF_FFFF;

/// Instructions = ticks · `FACTOR` / 2^`SHIFT`: 62.5 ns per tick, 256 ns per instruction.
const FACTOR: u32 = 125;
const SHIFT: u32 = 9;

/// The running SysTick.
pub(crate) struct Counter {
    systick: SYST,
    start: u32,
}

impl Counter {
    /// Starts the SysTick from the processor's clock, without interrupts.
    pub(crate) fn new() -> Self {
        #[allow(unsafe_code)] // Nothing else in an image uses the SysTick.
        let mut systick = unsafe { cortex_m::Peripherals::steal() }.SYST;
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(FULL);
        systick.clear_current();
        systick.enable_counter();
        Self { systick, start: 0 }
    }

    /// Starts counting.
    #[inline(always)]
    pub(crate) fn start(&mut self) {
        // From zero the counter wraps to its full value, so the whole range is available.
        self.systick.clear_current();
        self.start = SYST::get_current();
    }

    /// Instructions since [`Counter::start`]; `None` above 4.0 million.
    #[inline(always)]
    pub(crate) fn elapsed(&mut self) -> Option<u32> {
        let end = SYST::get_current();
        if self.systick.has_wrapped() {
            return None;
        }
        let ticks = self.start.wrapping_sub(end) & FULL;
        Some((ticks * FACTOR + (1 << (SHIFT - 1))) >> SHIFT)
    }
}
