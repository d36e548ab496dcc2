//! `libkestirim.a`: the functions of `kestirim.h`.

#![no_std]

// The library exports this crate's functions.
use kestirim_c as _;

// On a computer, `core` is compiled for programs that unwind, and needs to be told how.
#[cfg(not(target_os = "none"))]
extern crate std;

/// The panic handler is never called: nothing in the library can panic, as a test shows for every image linked with it.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
