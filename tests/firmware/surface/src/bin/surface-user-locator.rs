#![no_std]
#![no_main]

surface::image!(surface::user_locator::run);
