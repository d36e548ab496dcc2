//! Everything of `kestirim-particle-filter`, linked.

#![no_std]
#![no_main]

#[path = "../particle_filter.rs"]
mod particle_filter;

use surface::values;

surface::image!(particle_filter::run);
