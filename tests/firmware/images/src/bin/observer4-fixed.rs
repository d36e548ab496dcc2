//! The aeroplane's observer at 100 Hz in fixed point.

#![no_std]
#![no_main]

use images::observer::run_100_hz;
use kestirim_scalar::Q16_16;
use support::image;

image!(run_100_hz::<Q16_16>);
