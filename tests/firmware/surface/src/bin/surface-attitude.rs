//! Everything of `kestirim-attitude`, linked.

#![no_std]
#![no_main]

#[path = "../attitude.rs"]
mod attitude;

use surface::values;

surface::image!(attitude::run);
