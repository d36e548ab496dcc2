//! How an application ends: with the emulation.

use core::panic::PanicInfo;

use semihosting::process;
use semihosting::sys::arm_compat::{sys_write0, sys_writec};

/// Ends the emulation: all went well.
pub fn exit() -> ! {
    process::exit(0)
}

/// Ends the emulation as a failure.
pub fn fail() -> ! {
    process::exit(1)
}

/// A panic is a failure that names its place. (Its message is left out: formatting it costs flash.)
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    sys_write0(c"panicked in ");
    for &byte in info.location().map_or("", |place| place.file()).as_bytes() {
        sys_writec(byte);
    }
    sys_write0(c"\n");
    fail()
}

/// A fault of the processor, by the name that `cortex-m-rt` looks for.
#[allow(unsafe_code)] // Overrides the weak default, which would spin until the host's patience ends.
#[unsafe(export_name = "HardFault")]
extern "C" fn hard_fault() -> ! {
    sys_write0(c"hard fault\n");
    fail()
}
