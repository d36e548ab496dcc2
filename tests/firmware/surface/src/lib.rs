//! Calls everything that the crates offer, with one module for each crate.
//!
//! Each function is called by its path (`Gaussian::update(&mut estimate, …)`), so that
//! `tests/tests/all/surface_is_complete.rs` can compare the calls with the public functions. `Debug` and `Display` are
//! left out: `core::fmt` has panics of its own.
//!
//! For a target each module is a binary, and none of them is ever run: the optimiser knows nothing of any argument, so
//! that whatever could panic is linked (`tests/tests/all/panic_free.rs`). On the host arguments are drawn at random,
//! and all modules run (`all.rs`, `tests/tests/all/any_input.rs`).

#![cfg_attr(target_os = "none", no_std)]

pub mod values;

/// Makes a program of `$run`, a `fn()`.
#[macro_export]
macro_rules! image {
    ($run:path) => {
        #[allow(unsafe_code)] // The symbol is claimed once: a program has one `main`.
        #[unsafe(export_name = "main")]
        extern "C" fn main() {
            $run();
        }

        #[panic_handler]
        fn panic(_: &core::panic::PanicInfo) -> ! {
            loop {}
        }
    };
}
