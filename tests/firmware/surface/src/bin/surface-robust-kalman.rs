//! Everything of `kestirim-robust-kalman`, linked.

#![no_std]
#![no_main]

surface::image!(surface::robust_kalman::run);
