//! The aeroplane's observer at 100 Hz in single precision.

#![no_std]
#![no_main]

use images::observer::run_100_hz;
use support::image;

image!(run_100_hz::<f32>);
