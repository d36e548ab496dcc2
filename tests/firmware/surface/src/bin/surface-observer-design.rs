//! Everything of `kestirim-observer-design`, linked.

#![no_std]
#![no_main]

#[path = "../observer_design.rs"]
mod observer_design;

use surface::values;

surface::image!(observer_design::run);
