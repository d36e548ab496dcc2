//! Checks the meter with code of known cost; the host knows the expected results.

#![no_std]
#![no_main]

use core::hint::black_box;

use support::{Class, Meter, image, known};

/// The iterations of the spins. The long one is close to what the counter of every target can hold.
const SHORT: u32 = 50_000;
const LONG: u32 = 1_250_000;

fn run() {
    measure("nothing", || {});
    measure("thousand_nops", known::thousand_nops);
    spin("spin_short", SHORT);
    spin("spin_long", LONG);
    measure("stack_64", known::use_stack::<64>);
    measure("stack_1024", known::use_stack::<1024>);
    measure("stack_4096", known::use_stack::<4096>);
}

fn spin(name: &str, turns: u32) {
    let turns = black_box(turns);
    measure(name, || known::spin(turns));
}

/// Measures ten times: the host checks that all results agree.
#[inline(always)] // Otherwise the call of `code` would be measured, too.
fn measure(name: &str, mut code: impl FnMut()) {
    let mut meter = Meter::new();
    for _ in 0..10 {
        meter.measure(|| {
            code();
            Class::Predict
        });
    }
    meter.report(name);
}

image!(run);
