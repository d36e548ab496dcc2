//! Designs the aeroplane's observers on the target itself: its plant at 100 Hz, the gain that places four poles, and
//! the steady-state Kalman gain.
//!
//! Prints every column of A, B and the gains as the bits of its numbers, and the cost of each design.

#![no_std]
#![no_main]

use images::design::{held, placed, settled};
use kestirim_observer_design::Error;
use kestirim_scalar::Columns;
use nalgebra::SMatrix;
use support::{Class, Meter, fail, image, line};

/// The measured depth of the stack, bytes, which exceeds that of any design.
const REACH: usize = 64 * 1024;

fn run() {
    let plant = designed("zero_order_hold", held);
    tell("a", &plant.a);
    tell("b", &plant.b);
    tell("luenberger", &designed("place", || placed(&plant)).gain);
    let kalman = designed("riccati", || settled(&plant));
    tell("kalman_filter", &kalman.filter_gain);
    tell("kalman_predictor", &kalman.predictor_gain);
}

#[inline(always)] // Otherwise the call of `design` would be measured, too.
fn designed<T>(name: &str, design: impl Fn() -> Result<T, Error>) -> T {
    let mut meter = Meter::reaching(REACH);
    let mut answer = Err(Error::NotConverged);
    meter.measure(|| {
        answer = design();
        Class::Start
    });
    meter.report(name);
    answer.unwrap_or_else(|_| fail(name))
}

fn tell<const R: usize, const C: usize>(key: &str, matrix: &SMatrix<f64, R, C>) {
    for column in matrix.as_columns() {
        line(key, &column.map(|number| number.to_bits() as i64));
    }
}

image!(run);
