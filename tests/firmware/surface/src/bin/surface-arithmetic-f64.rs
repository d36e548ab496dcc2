//! Links the double precision of `kestirim-arithmetic`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../arithmetic_f64.rs"]
mod arithmetic_f64;

use surface::values;

surface::image!(arithmetic_f64::run);
