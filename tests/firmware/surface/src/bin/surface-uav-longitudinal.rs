//! Everything of `kestirim-uav-longitudinal`, linked.

#![no_std]
#![no_main]

surface::image!(surface::uav_longitudinal::run);
