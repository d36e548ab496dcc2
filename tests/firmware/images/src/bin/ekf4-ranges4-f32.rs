//! The common scenario with the extended Kalman filter, in single precision.

#![no_std]
#![no_main]

use images::four_ranges::Ekf;
use images::replay::run;
use support::image;

image!(run::<Ekf<f32>>);
