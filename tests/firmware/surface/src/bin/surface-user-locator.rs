//! Everything of `kestirim-user-locator`, linked.

#![no_std]
#![no_main]

surface::image!(surface::user_locator::run);
