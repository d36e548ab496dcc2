//! Links everything of `kestirim-pedestrian`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../pedestrian.rs"]
mod pedestrian;

use surface::values;

surface::image!(pedestrian::run);
