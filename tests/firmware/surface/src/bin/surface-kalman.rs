//! Links everything of `kestirim-kalman`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../kalman.rs"]
mod kalman;

use surface::values;

surface::image!(kalman::run);
