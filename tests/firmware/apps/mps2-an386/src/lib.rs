//! Interrupts of QEMU's machine `mps2-an386` (Arm's application note AN386), as far as the applications need them: what
//! svd2rust would generate from the chip's description, if there were one.

#![no_std]

use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::NVIC;

// Under the names by which `#[interrupt]` and RTIC look for both.
pub use self::Interrupt as interrupt;
pub use cortex_m_rt::interrupt;

/// The number of bits of an interrupt's priority.
pub const NVIC_PRIO_BITS: u8 = 3;

/// An interrupt, by the name of its handler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum Interrupt {
    /// The first serial port has received a byte.
    UARTRX0 = 0,
    /// The first serial port can send again.
    UARTTX0 = 1,
    /// A pin; free for other uses of a program.
    GPIO0 = 6,
}

/// Unmasks an interrupt.
///
/// A handler only shares with the rest of the program what is made for sharing, like all safe code.
pub fn unmask(interrupt: Interrupt) {
    #[allow(unsafe_code)]
    // These programs have no mask-based critical sections, which this could break.
    unsafe {
        NVIC::unmask(interrupt);
    }
}

#[allow(unsafe_code)] // The numbers are those of the machine, and of this enum.
unsafe impl InterruptNumber for Interrupt {
    fn number(self) -> u16 {
        self as u16
    }
}

/// An entry of the vector table.
pub union Vector {
    handler: unsafe extern "C" fn(),
    reserved: usize,
}

#[allow(unsafe_code)] // Handlers, by their names.
unsafe extern "C" {
    fn UARTRX0();
    fn UARTTX0();
    fn GPIO0();
}

/// The handlers, where `cortex-m-rt` makes the linker look for them.
#[allow(unsafe_code)] // A table of addresses that the processor reads.
#[unsafe(link_section = ".vector_table.interrupts")]
#[unsafe(no_mangle)]
pub static __INTERRUPTS: [Vector; 7] = [
    Vector { handler: UARTRX0 },
    Vector { handler: UARTTX0 },
    Vector { reserved: 0 },
    Vector { reserved: 0 },
    Vector { reserved: 0 },
    Vector { reserved: 0 },
    Vector { handler: GPIO0 },
];
