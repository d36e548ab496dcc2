//! Everything of `kestirim-gnss-ppp`, linked.

#![no_std]
#![no_main]

#[path = "../gnss_ppp.rs"]
mod gnss_ppp;

use surface::values;

surface::image!(gnss_ppp::run);
