//! Links everything of `kestirim-uav-longitudinal`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../uav_longitudinal.rs"]
mod uav_longitudinal;

use surface::values;

surface::image!(uav_longitudinal::run);
