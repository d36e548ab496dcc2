//! The drone's particle filter in single precision.

#![no_std]
#![no_main]

use images::path_loss::Published;
use images::replay::run;
use support::image;

image!(run::<Published<f32>>);
