//! The common scenario with the robust filter, in single precision.

#![no_std]
#![no_main]

use images::four_ranges::Robust;
use images::replay::run;
use support::image;

image!(run::<Robust<f32>>);
