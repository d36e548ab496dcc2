//! Links everything of `kestirim-scalar`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../scalar.rs"]
mod scalar;

use surface::values;

surface::image!(scalar::run);
