//! Links everything of `kestirim-uwb-tracker`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../uwb_tracker.rs"]
mod uwb_tracker;

use surface::values;

surface::image!(uwb_tracker::run);
