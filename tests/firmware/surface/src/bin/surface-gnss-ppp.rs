//! Links everything of `kestirim-gnss-ppp`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../gnss_ppp.rs"]
mod gnss_ppp;

use surface::values;

surface::image!(gnss_ppp::run);
