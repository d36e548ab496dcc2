//! Links everything of `kestirim-robust-kalman`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../robust_kalman.rs"]
mod robust_kalman;

use surface::values;

surface::image!(robust_kalman::run);
