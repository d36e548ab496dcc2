//! A step longer than the counter of any Cortex-M can count: the image must fail instead of reporting a wrong number.

#![no_std]
#![no_main]

use core::hint::black_box;

use support::{Class, Meter, image, known};

fn run() {
    let turns = black_box(350_000_000);
    let mut meter = Meter::new();
    meter.measure(|| {
        known::spin(turns);
        Class::Predict
    });
    meter.report("overrun");
}

image!(run);
