//! Ends an application by ending the emulation.

use core::panic::PanicInfo;

use semihosting::process;
use semihosting::sys::arm_compat::{sys_write0, sys_writec};

/// Ends the emulation successfully.
pub fn exit() -> ! {
    process::exit(0)
}

/// Ends the emulation as a failure.
pub fn fail() -> ! {
    process::exit(1)
}

/// Reports the location of a panic as a failure. (The message is left out: formatting it costs flash.)
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    sys_write0(c"panicked in ");
    for &byte in info.location().map_or("", |place| place.file()).as_bytes() {
        sys_writec(byte);
    }
    sys_write0(c"\n");
    fail()
}

/// The handler for processor faults, under the name that `cortex-m-rt` looks for.
#[allow(unsafe_code)] // Overrides the weak default, which would spin until the host's patience ends.
#[unsafe(export_name = "HardFault")]
extern "C" fn hard_fault() -> ! {
    sys_write0(c"hard fault\n");
    fail()
}
