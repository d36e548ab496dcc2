//! Links the double precision of `kestirim-luenberger`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../luenberger_f64.rs"]
mod luenberger_f64;

use surface::values;

surface::image!(luenberger_f64::run);
