//! The aeroplane's observer at 1 kHz in single precision.

#![no_std]
#![no_main]

use images::observer::run_1_khz;
use support::image;

image!(run_1_khz::<f32>);
