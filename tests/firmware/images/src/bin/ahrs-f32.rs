//! The attitude reference, in single precision.

#![no_std]
#![no_main]

use images::attitude::Reference;
use images::replay::run;
use support::image;

image!(run::<Reference<f32>>);
