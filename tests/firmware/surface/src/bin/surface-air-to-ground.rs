//! Everything of `kestirim-air-to-ground`, linked.

#![no_std]
#![no_main]

surface::image!(surface::air_to_ground::run);
