//! Measures the stack use of a call: paint the free stack, call, and look how much paint is left.
//!
//! A frame whose lowest words are reserved but never written appears too small by those words.

use core::arch::asm;
use core::ptr;

const PAINT: u32 = 0xC0DE_7E57;
const WORD: usize = size_of::<u32>();

/// The painted part of the stack: from `bottom` up to the stack pointer `top`.
pub(crate) struct Painted {
    bottom: usize,
    top: usize,
}

impl Painted {
    /// Paints the free stack below the caller's frame, `reach` bytes of it where there is that much.
    /// Inlined, so that the stack pointer is the caller's.
    #[inline(always)]
    pub(crate) fn below(reach: usize) -> Self {
        let top = stack_pointer();
        let bottom = end_of_statics().max(top.saturating_sub(reach));
        for address in (bottom..top).step_by(WORD) {
            let word = ptr::with_exposed_provenance_mut::<u32>(address);
            #[allow(unsafe_code)] // Free memory: between the static variables and the stack.
            unsafe {
                ptr::write_volatile(word, PAINT);
            }
        }
        Self { bottom, top }
    }

    /// The number of painted bytes used since then, counted from the top; `None` if all of them were.
    #[inline(always)]
    pub(crate) fn used(&self) -> Option<u32> {
        let is_clean = |address: &usize| {
            let word = ptr::with_exposed_provenance::<u32>(*address);
            #[allow(unsafe_code)] // The memory that `below` painted.
            let word = unsafe { ptr::read_volatile(word) };
            word == PAINT
        };
        let clean = (self.bottom..self.top).step_by(WORD).take_while(is_clean).count() * WORD;
        (clean > 0).then_some((self.top - self.bottom - clean) as u32)
    }
}

/// The end of the static variables, under the name that both run-time crates give it.
#[inline(always)]
fn end_of_statics() -> usize {
    #[allow(unsafe_code)] // Declares a symbol of the linker script; only its address is taken.
    unsafe extern "C" {
        static __sheap: u8;
    }
    (&raw const __sheap).expose_provenance()
}

/// The stack pointer of the function that this is inlined into.
#[inline(always)]
fn stack_pointer() -> usize {
    let address: usize;
    #[allow(unsafe_code)] // Copies a register.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("mov {}, sp", out(reg) address, options(nomem, nostack, preserves_flags));
        #[cfg(target_arch = "riscv32")]
        asm!("mv {}, sp", out(reg) address, options(nomem, nostack, preserves_flags));
    }
    address
}
