//! The counterexample to the other programs: it can panic, and computes in double precision.

#![no_std]
#![no_main]

use surface::values::{keep, numbers, whole};

fn run() {
    let values = numbers::<f64, 4>();
    keep(values[whole::<usize>()] * values[0]);
}

surface::image!(run);
