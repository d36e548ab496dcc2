//! Everything of `kestirim-observer-design`, linked.

#![no_std]
#![no_main]

surface::image!(surface::observer_design::run);
