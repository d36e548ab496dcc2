#![no_std]
#![no_main]

surface::image!(surface::uwb_tracker::run);
