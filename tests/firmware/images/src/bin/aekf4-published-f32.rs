//! The paper's adaptive filter as published, in single precision.

#![no_std]
#![no_main]

use images::four_ranges::Published;
use images::replay::run;
use support::image;

image!(run::<Published<f32>>);
