//! The common scenario with `minikalman`, in single precision.

#![no_std]
#![no_main]

use images::replay::run;
use peers::minikalman::Minikalman;
use support::image;

image!(run::<Minikalman<f32>>);
