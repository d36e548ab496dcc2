//! Everything of `kestirim-uwb-tracker`, linked.

#![no_std]
#![no_main]

surface::image!(surface::uwb_tracker::run);
