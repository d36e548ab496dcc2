//! A robust update, worst first, of codes and phases of many satellites.

use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{Decision, Measurement, Robust};
use nalgebra::SVector;

use crate::{Curve, fastest};

/// Position, clock, zenith delay and an ambiguity for each of forty satellites.
const STATES: usize = 45;
const MOST: usize = 80;

/// By how many measurements, of which none stands out.
pub(crate) fn measurements() -> Curve {
    [10, 20, 40, MOST].map(|count| (count as f64, update(count, 0))).into()
}

/// By how many of eighty are off by 20 deviations.
pub(crate) fn outliers() -> Curve {
    [0, 1, 2, 5, 10, 15, 20].map(|count| (count as f64, update(MOST, count))).into()
}

fn update(count: usize, outliers: usize) -> f64 {
    let variances: [f64; STATES] =
        std::array::from_fn(|state| if state == 3 { 100.0 } else { 0.05 });
    let covariance = Covariance::from_variances(&variances);
    let predicted = Gaussian::new(SVector::zeros(), covariance);
    let number = |index: usize, of: f64| (index as f64 * of).sin();
    let rows = (0..count).map(|index| {
        let own = if index % 2 == 1 { 5 + index / 2 } else { 4 };
        let place = [1.1, 2.3, 3.7].map(|of| number(index, of));
        [(0, place[0]), (1, place[1]), (2, place[2]), (3, 1.0), (own, 0.7)]
    });
    let rows: Vec<_> = rows.collect();
    let epoch = rows.iter().enumerate().map(|(index, row)| {
        let sigma = if index % 2 == 1 { 0.1 } else { 0.3 };
        // A shuffled order.
        let is_off = (index * 37) % MOST < outliers;
        let off = if is_off { 20.0_f64.copysign(number(index, 5.3)) } else { number(index, 1.7) };
        Measurement { row, innovation: sigma * off, variance: sigma * sigma }
    });
    let epoch: Vec<_> = epoch.collect();
    let mut decisions = [Decision::NONE; MOST];
    fastest(400, || {
        let mut estimate = predicted;
        Robust::iterative_igg3().update(&mut estimate, &epoch, &mut decisions[..count])
    })
}
