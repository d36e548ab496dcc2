//! Links everything of `kestirim-observer-design`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../observer_design.rs"]
mod observer_design;

use surface::values;

surface::image!(observer_design::run);
