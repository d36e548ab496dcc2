//! Everything that the crates offer, called: a module a crate.
//!
//! Each function is called by its path (`Gaussian::update(&mut estimate, …)`), so that
//! `tests/tests/all/surface_is_complete.rs` can compare what is called with what is public. `Debug` and `Display` are
//! left out: `core::fmt` has panics of its own.
//!
//! For a target the binaries link it, and none of them is ever run: the optimiser knows nothing of any
//! argument, so that whatever could panic is linked (`tests/tests/all/panic_free.rs`). On the host arguments are drawn at
//! random, and it runs: `tests/tests/all/any_input.rs`.

#![cfg_attr(target_os = "none", no_std)]

pub mod adaptive_kalman;
pub mod air_to_ground;
pub mod attitude;
pub mod gnss_ppp;
pub mod kalman;
pub mod luenberger;
pub mod luenberger_f64;
pub mod observer_design;
pub mod particle_filter;
pub mod pedestrian;
pub mod ppp_filter;
pub mod robust_kalman;
pub mod scalar;
pub mod scalar_f64;
pub mod telemetry;
pub mod uav_estimator;
pub mod uav_longitudinal;
pub mod user_locator;
pub mod uwb_ranging;
pub mod uwb_tracker;
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
