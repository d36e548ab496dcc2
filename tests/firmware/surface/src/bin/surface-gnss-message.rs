//! Links everything of `kestirim-gnss-message`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../gnss_message.rs"]
mod gnss_message;

use surface::values;

surface::image!(gnss_message::run);
