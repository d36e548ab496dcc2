//! The beginning and end of an image.

use core::panic::PanicInfo;

use semihosting::process;

use crate::line::{line, line_of_text};

/// Makes a bootable image of `$run`, a `fn()`: the run-time crate of either processor family initialises memory and
/// calls the symbol `main`.
#[macro_export]
macro_rules! image {
    ($run:path) => {
        #[allow(unsafe_code)] // The symbol is claimed once: an image has one `main`.
        #[unsafe(export_name = "main")]
        extern "C" fn main() -> ! {
            $run();
            $crate::exit()
        }
    };
}

/// Ends the emulation successfully.
pub fn exit() -> ! {
    process::exit(0)
}

/// Prints `failed=reason` and ends the emulation as a failure.
pub fn fail(reason: &str) -> ! {
    line_of_text("failed", reason);
    process::exit(1)
}

/// Reports the location of a panic as a failure. (The message is left out: formatting would cost more flash than most
/// workloads.)
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    if let Some(place) = info.location() {
        line_of_text("panicked_in", place.file());
        line("panicked_at_line", &[place.line().into()]);
    }
    fail("panic")
}

/// The handler for processor faults, under the name that `cortex-m-rt` looks for.
#[cfg(target_arch = "arm")]
#[allow(unsafe_code)] // Overrides the weak default, which would spin until the host's patience ends.
#[unsafe(export_name = "HardFault")]
extern "C" fn hard_fault() -> ! {
    fail("hard fault")
}

/// The handler for processor faults, under the name that `riscv-rt` looks for.
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)] // Overrides the weak default, which would spin until the host's patience ends.
#[unsafe(export_name = "ExceptionHandler")]
extern "C" fn exception() -> ! {
    fail("exception")
}
