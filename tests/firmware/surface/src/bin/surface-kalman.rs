//! Everything of `kestirim-kalman`, linked.

#![no_std]
#![no_main]

surface::image!(surface::kalman::run);
