//! Everything of `kestirim-uav-longitudinal`, linked.

#![no_std]
#![no_main]

#[path = "../uav_longitudinal.rs"]
mod uav_longitudinal;

use surface::values;

surface::image!(uav_longitudinal::run);
