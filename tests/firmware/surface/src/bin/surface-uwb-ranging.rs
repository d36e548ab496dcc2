//! Everything of `kestirim-uwb-ranging`, linked.

#![no_std]
#![no_main]

surface::image!(surface::uwb_ranging::run);
