//! The drone's particle filter in fixed point.

#![no_std]
#![no_main]

use images::path_loss::Published;
use images::replay::run;
use kestirim_scalar::Q16_16;
use support::image;

image!(run::<Published<Q16_16>>);
