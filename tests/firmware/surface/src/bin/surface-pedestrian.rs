//! Everything of `kestirim-pedestrian`, linked.

#![no_std]
#![no_main]

#[path = "../pedestrian.rs"]
mod pedestrian;

use surface::values;

surface::image!(pedestrian::run);
