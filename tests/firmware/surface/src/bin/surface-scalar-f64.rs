//! The double precision of `kestirim-scalar`, linked.

#![no_std]
#![no_main]

#[path = "../scalar_f64.rs"]
mod scalar_f64;

use surface::values;

surface::image!(scalar_f64::run);
