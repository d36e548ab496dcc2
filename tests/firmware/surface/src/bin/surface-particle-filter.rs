//! Everything of `kestirim-particle-filter`, linked.

#![no_std]
#![no_main]

surface::image!(surface::particle_filter::run);
