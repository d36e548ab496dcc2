//! Links everything of `kestirim-ppp-filter`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../ppp_filter.rs"]
mod ppp_filter;

use surface::values;

surface::image!(ppp_filter::run);
