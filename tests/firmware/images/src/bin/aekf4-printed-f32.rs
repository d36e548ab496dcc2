//! The paper's adaptive filter as printed, in single precision.

#![no_std]
#![no_main]

use images::four_ranges::Printed;
use images::replay::run;
use support::image;

image!(run::<Printed<f32>>);
