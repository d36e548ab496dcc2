//! The drone's particle filter in single precision.

#![no_std]
#![no_main]

use images::path_loss::Printed;
use images::replay::run;
use support::image;

image!(run::<Printed<f32>>);
