//! `libkestirim.a`: the functions of `kestirim.h`.

#![no_std]

// Its functions are what is exported.
use kestirim_c as _;

// Of a computer, `core` comes compiled for programs that unwind, and wants to be told how.
#[cfg(not(target_os = "none"))]
extern crate std;

/// Never called: nothing in the library can panic, which a test shows of every image that is linked with it.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
