//! The common scenario with `kfilter`, in single precision.

#![no_std]
#![no_main]

use images::replay::run;
use peers::kfilter::Kfilter;
use support::image;

image!(run::<Kfilter>);
