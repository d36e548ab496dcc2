//! Links everything of `kestirim-attitude`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../attitude.rs"]
mod attitude;

use surface::values;

surface::image!(attitude::run);
