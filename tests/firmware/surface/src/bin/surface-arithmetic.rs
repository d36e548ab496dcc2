//! Links everything of `kestirim-arithmetic`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../arithmetic.rs"]
mod arithmetic;

use surface::values;

surface::image!(arithmetic::run);
