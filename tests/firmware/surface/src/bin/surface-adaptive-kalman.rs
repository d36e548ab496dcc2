//! Links everything of `kestirim-adaptive-kalman`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../adaptive_kalman.rs"]
mod adaptive_kalman;

use surface::values;

surface::image!(adaptive_kalman::run);
