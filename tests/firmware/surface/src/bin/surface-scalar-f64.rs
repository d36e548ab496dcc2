//! Links the double precision of `kestirim-scalar`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../scalar_f64.rs"]
mod scalar_f64;

use surface::values;

surface::image!(scalar_f64::run);
