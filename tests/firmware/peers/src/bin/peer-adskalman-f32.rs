//! The common scenario with `adskalman`, in single precision.

#![no_std]
#![no_main]

use images::replay::run;
use peers::adskalman::Adskalman;
use support::image;

image!(run::<Adskalman>);
