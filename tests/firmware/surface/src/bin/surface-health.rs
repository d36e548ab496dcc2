//! Links everything of `kestirim-health`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../health.rs"]
mod health;

use surface::values;

surface::image!(health::run);
