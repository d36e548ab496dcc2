//! Everything of `kestirim-attitude`, linked.

#![no_std]
#![no_main]

surface::image!(surface::attitude::run);
