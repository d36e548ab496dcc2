//! A tag in the plane among eight anchors, in single precision.

#![no_std]
#![no_main]

use images::replay::run;
use images::uwb::Plane;
use support::image;

image!(run::<Plane<f32, 8>>);
