//! What the other binaries must not be: it can panic, and computes in double precision.

#![no_std]
#![no_main]

use surface::{any, image, keep, numbers};

fn run() {
    let values = numbers::<f64, 4>();
    keep(values[any(1)] * values[0]);
}

image!(run);
