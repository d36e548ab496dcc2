//! The common scenario with the extended Kalman filter, in fixed point with 16 fractional bits.

#![no_std]
#![no_main]

use images::four_ranges::Ekf;
use images::replay::run;
use kestirim_scalar::Q16_16;
use support::image;

image!(run::<Ekf<Q16_16>>);
