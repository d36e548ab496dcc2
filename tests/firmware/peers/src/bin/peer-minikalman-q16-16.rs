//! The common scenario with `minikalman`, in the fixed point that it offers.

#![no_std]
#![no_main]

use fixed::types::I16F16;
use images::replay::run;
use peers::minikalman::Minikalman;
use support::image;

image!(run::<Minikalman<I16F16>>);
