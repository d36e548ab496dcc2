//! Everything of `kestirim-user-locator`, linked.

#![no_std]
#![no_main]

#[path = "../user_locator.rs"]
mod user_locator;

use surface::values;

surface::image!(user_locator::run);
