//! The double precision of `kestirim-luenberger`, linked.

#![no_std]
#![no_main]

#[path = "../luenberger_f64.rs"]
mod luenberger_f64;

use surface::values;

surface::image!(luenberger_f64::run);
