//! Everything of `kestirim-scalar`, linked.

#![no_std]
#![no_main]

#[path = "../scalar.rs"]
mod scalar;

use surface::values;

surface::image!(scalar::run);
