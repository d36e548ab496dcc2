//! Links everything of `kestirim-telemetry`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../telemetry.rs"]
mod telemetry;

use surface::values;

surface::image!(telemetry::run);
