//! Everything of `kestirim-robust-kalman`, linked.

#![no_std]
#![no_main]

#[path = "../robust_kalman.rs"]
mod robust_kalman;

use surface::values;

surface::image!(robust_kalman::run);
