//! Links everything of `kestirim-uwb-ranging`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../uwb_ranging.rs"]
mod uwb_ranging;

use surface::values;

surface::image!(uwb_ranging::run);
