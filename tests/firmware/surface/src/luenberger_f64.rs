//! Computes the gains of `kestirim-luenberger` at run time, in double precision; otherwise the compiler computes them.

use kestirim_luenberger::{CurrentGains, DisturbanceGains, Plant, PredictorGains, ReducedGains};

use super::values::{any, call_each, keep, matrix, whole};

fn full<const N: usize, const M: usize, const P: usize, const D: usize>() {
    let plant = any(Plant::<N, M, P> { a: matrix(), b: matrix(), c: matrix() });
    keep(PredictorGains::new(&plant, &matrix()));
    keep(CurrentGains::new(&plant, &matrix()));
    let (state, disturbance) = (matrix(), matrix());
    let entry = matrix::<f64, N, D>();
    keep(DisturbanceGains::new(&plant, &entry, &matrix(), &state, &disturbance));
}

fn reduced<const N: usize, const M: usize, const P: usize, const R: usize>() {
    keep(ReducedGains::<N, M, P, R>::new(
        &matrix(),
        &matrix(),
        &[(); P].map(|()| whole()),
        &matrix(),
    ));
}

/// Calls everything in this module.
pub fn run() {
    call_each([
        full::<4, 2, 3, 1>,
        full::<9, 3, 5, 2>,
        reduced::<4, 2, 2, 2>,
        reduced::<9, 3, 2, 7>,
    ]);
}
