//! Links everything of `kestirim-air-to-ground`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../air_to_ground.rs"]
mod air_to_ground;

use surface::values;

surface::image!(air_to_ground::run);
