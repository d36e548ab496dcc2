//! The aeroplane's observer at 1 kHz in fixed point.

#![no_std]
#![no_main]

use images::observer::run_1_khz;
use kestirim_scalar::Q16_16;
use support::image;

image!(run_1_khz::<Q16_16>);
