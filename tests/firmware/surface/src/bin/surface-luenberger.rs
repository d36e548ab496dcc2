//! Everything of `kestirim-luenberger`, linked.

#![no_std]
#![no_main]

#[path = "../luenberger.rs"]
mod luenberger;

use surface::values;

surface::image!(luenberger::run);
