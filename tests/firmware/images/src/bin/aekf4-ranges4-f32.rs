//! The paper's adaptive filter in its safe form, in single precision.

#![no_std]
#![no_main]

use images::four_ranges::Aekf;
use images::replay::run;
use support::image;

image!(run::<Aekf<f32>>);
