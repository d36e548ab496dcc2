//! The common scenario with the extended Kalman filter, in fixed point with 24 fractional bits.

#![no_std]
#![no_main]

use images::four_ranges::Ekf;
use images::replay::run;
use kestirim_scalar::Q8_24;
use support::image;

image!(run::<Ekf<Q8_24>>);
