//! Everything of `kestirim-scalar`, linked.

#![no_std]
#![no_main]

surface::image!(surface::scalar::run);
