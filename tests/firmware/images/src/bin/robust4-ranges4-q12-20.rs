//! The common scenario with the robust filter, in fixed point.

#![no_std]
#![no_main]

use images::four_ranges::Robust;
use images::replay::run;
use kestirim_scalar::Q12_20;
use support::image;

image!(run::<Robust<Q12_20>>);
