//! A tag in space among eight anchors, in single precision.

#![no_std]
#![no_main]

use images::replay::run;
use images::uwb::Space;
use support::image;

image!(run::<Space<f32, 8>>);
