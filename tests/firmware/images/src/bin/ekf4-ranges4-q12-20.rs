//! The common scenario with the extended Kalman filter, in fixed point with 20 fractional bits.

#![no_std]
#![no_main]

use images::four_ranges::Ekf;
use images::replay::run;
use kestirim_scalar::Q12_20;
use support::image;

image!(run::<Ekf<Q12_20>>);
