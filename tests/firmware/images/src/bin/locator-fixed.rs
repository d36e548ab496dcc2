//! The drone's particle filter in fixed point.

#![no_std]
#![no_main]

use images::path_loss::Printed;
use images::replay::run;
use kestirim_scalar::Q16_16;
use support::image;

image!(run::<Printed<Q16_16>>);
