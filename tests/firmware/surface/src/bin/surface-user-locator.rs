//! Links everything of `kestirim-user-locator`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../user_locator.rs"]
mod user_locator;

use surface::values;

surface::image!(user_locator::run);
