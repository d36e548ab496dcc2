//! The gains of `kestirim-luenberger`, made at run time: in double precision, as the compiler does otherwise.

#![no_std]
#![no_main]

use kestirim_luenberger::{CurrentGains, DisturbanceGains, Plant, PredictorGains, ReducedGains};
use surface::{any, call_each, image, keep, matrix};

fn full<const N: usize, const M: usize, const P: usize, const D: usize>() {
    let plant = any(Plant::<N, M, P> { a: matrix(), b: matrix(), c: matrix() });
    keep(PredictorGains::new(&plant, &matrix()));
    keep(CurrentGains::new(&plant, &matrix()));
    let (state, disturbance) = (matrix(), matrix());
    let entry = matrix::<f64, N, D>();
    keep(DisturbanceGains::new(&plant, &entry, &matrix(), &state, &disturbance));
}

fn reduced<const N: usize, const M: usize, const P: usize, const R: usize>() {
    keep(ReducedGains::<N, M, P, R>::new(&matrix(), &matrix(), &any([1; P]), &matrix()));
}

fn run() {
    call_each([
        full::<4, 2, 3, 1>,
        full::<9, 3, 5, 2>,
        reduced::<4, 2, 2, 2>,
        reduced::<9, 3, 2, 7>,
    ]);
}

image!(run);
