//! Everything of `kestirim-adaptive-kalman`, linked.

#![no_std]
#![no_main]

surface::image!(surface::adaptive_kalman::run);
