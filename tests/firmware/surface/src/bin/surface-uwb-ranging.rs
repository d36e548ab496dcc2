//! Everything of `kestirim-uwb-ranging`, linked.

#![no_std]
#![no_main]

#[path = "../uwb_ranging.rs"]
mod uwb_ranging;

use surface::values;

surface::image!(uwb_ranging::run);
