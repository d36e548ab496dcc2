//! Memory-mapped registers of peripherals.

use core::ptr;

/// A 32-bit register without side effects on memory.
#[derive(Clone, Copy)]
pub(crate) struct Register(usize);

impl Register {
    /// The register at an address in this board's peripheral map; other addresses do not compile.
    pub(crate) const fn at(address: usize) -> Self {
        assert!(address >= 0x4000_0000 && address < 0x4010_0000 && address.is_multiple_of(4));
        Self(address)
    }

    pub(crate) fn read(self) -> u32 {
        #[allow(unsafe_code)] // A peripheral's register: see `at`.
        unsafe {
            ptr::read_volatile(ptr::with_exposed_provenance(self.0))
        }
    }

    pub(crate) fn write(self, value: u32) {
        #[allow(unsafe_code)] // A peripheral's register: see `at`.
        unsafe {
            ptr::write_volatile(ptr::with_exposed_provenance_mut(self.0), value);
        }
    }
}
