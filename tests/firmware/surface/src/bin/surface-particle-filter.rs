//! Links everything of `kestirim-particle-filter`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../particle_filter.rs"]
mod particle_filter;

use surface::values;

surface::image!(particle_filter::run);
