//! Everything of `kestirim-kalman`, linked.

#![no_std]
#![no_main]

#[path = "../kalman.rs"]
mod kalman;

use surface::values;

surface::image!(kalman::run);
