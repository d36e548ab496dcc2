//! Measures the time of an update by 22 measurements, code and phase of eleven satellites:
//! `cargo run --release -p kestirim-robust-kalman --example cost`.

use core::hint::black_box;
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{Block, Decision, Measurement, Robust};
use nalgebra::SVector;
use std::time::Instant;

const SATELLITES: usize = 11;

/// Rows over three coordinates, a clock, a zenith delay and ambiguities from index 5 on.
fn rows() -> Vec<Vec<(usize, f64)>> {
    let row = |satellite: usize| {
        let azimuth = satellite as f64 * 2.4;
        let elevation = 0.2 + 0.12 * satellite as f64;
        let place = [
            -azimuth.sin() * elevation.cos(),
            -azimuth.cos() * elevation.cos(),
            -elevation.sin(),
            1.0,
            1.0 / elevation.sin(),
        ];
        place.into_iter().enumerate().collect::<Vec<_>>()
    };
    let codes = (0..SATELLITES).map(row);
    let phases = (0..SATELLITES).map(|satellite| {
        let mut row = row(satellite);
        row.push((5 + satellite, 1.0));
        row
    });
    codes.chain(phases).collect()
}

fn nanoseconds<const N: usize>(robust: Option<Robust<f64>>, outliers: usize) -> f64 {
    let mut variances = [0.0; N];
    for (index, variance) in variances.iter_mut().enumerate().take(5 + SATELLITES) {
        *variance = if index == 3 { 1e4 } else { 0.01 };
    }
    let predicted = Gaussian::new(SVector::zeros(), Covariance::from_variances(&variances));
    let rows = rows();
    let epoch: Vec<Measurement<'_, f64>> = (0..2 * SATELLITES)
        .map(|index| {
            let sigma = if index < SATELLITES { 0.9 } else { 0.009 };
            let wild = if index % 5 == 2 && index / 5 < outliers { 30.0 } else { 0.0 };
            let innovation = sigma * ((index as f64 * 1.7).sin() + wild);
            Measurement { row: &rows[index], innovation, variance: sigma * sigma }
        })
        .collect();
    let mut decisions = [Decision::NONE; 2 * SATELLITES];
    let mut run = || {
        let mut estimate = black_box(predicted);
        if let Some(robust) = &robust {
            robust.update(&mut estimate, black_box(&epoch), &mut decisions).expect("an update");
        } else {
            for measurement in black_box(&epoch) {
                let weighed = estimate
                    .weigh_entries(measurement.row, measurement.innovation, measurement.variance)
                    .expect("a weighing");
                estimate.correct(&weighed).expect("an update");
            }
        }
        black_box(estimate);
    };
    let batch = |run: &mut dyn FnMut()| {
        let start = Instant::now();
        (0..1000).for_each(|_| run());
        start.elapsed().as_secs_f64() * 1e6
    };
    (0..20).map(|_| batch(&mut run)).fold(f64::INFINITY, f64::min)
}

fn main() {
    let block = Block::new(0, 3);
    let filters = [
        ("scalar updates alone", None),
        ("plain", Some(Robust::plain())),
        ("IGG III", Some(Robust::igg3())),
        ("t-test", Some(Robust::t_test())),
        ("iterative IGG III", Some(Robust::iterative_igg3())),
        ("adaptive", Some(Robust::adaptive(block))),
    ];
    println!("ns an update    N = 17: clean, 1, 3 outliers    N = 37: clean, 1, 3 outliers");
    for (name, robust) in filters {
        let small = [0, 1, 3].map(|outliers| nanoseconds::<17>(robust, outliers));
        let large = [0, 1, 3].map(|outliers| nanoseconds::<37>(robust, outliers));
        println!("{name:22} {small:8.0?}   {large:8.0?}");
    }
}
