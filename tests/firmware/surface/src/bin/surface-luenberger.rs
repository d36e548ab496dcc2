//! Links everything of `kestirim-luenberger`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../luenberger.rs"]
mod luenberger;

use surface::values;

surface::image!(luenberger::run);
