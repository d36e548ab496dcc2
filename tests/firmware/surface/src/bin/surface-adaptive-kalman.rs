//! Everything of `kestirim-adaptive-kalman`, linked.

#![no_std]
#![no_main]

#[path = "../adaptive_kalman.rs"]
mod adaptive_kalman;

use surface::values;

surface::image!(adaptive_kalman::run);
