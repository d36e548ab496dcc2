//! Measures the cost of a step of the thesis' filter, and prints the resulting bits, which are the same with all
//! vector widths: `cargo run --release -p kestirim-user-locator --example step`, and with `--features vectors`.

use core::hint::black_box;
use std::time::Instant;

use kestirim_air_to_ground::{Channel, Environment, Measurement};
use kestirim_particle_filter::{Region, Xoshiro128PlusPlus};
use kestirim_scalar::Scalar;
use kestirim_user_locator::{PublishedLocator, PublishedSettings};
use rand_core::SeedableRng;

const PARTICLES: usize = 500;
const ROUNDS: usize = 400;
const LAPS: usize = 4;

/// A circle of twelve places around a user.
fn circle<T: Scalar>() -> Vec<Measurement<T>> {
    let stop = |index: i32| {
        let angle = f64::from(index) * core::f64::consts::TAU / 12.0;
        let [x, y] = [1500.0 + 1000.0 * angle.cos(), 1500.0 + 1000.0 * angle.sin()];
        let distance = ((x - 1200.0_f64).powi(2) + (y - 900.0_f64).powi(2) + 250_000.0).sqrt();
        let loss = 39.5 + 20.0 * distance.log10() + (f64::from(index) * 1.3).sin();
        let [x, y, height, loss] = [x, y, 500.0, loss].map(T::from_f64);
        Measurement::new([x, y], height, loss).expect("a place and a loss")
    };
    (0..12).map(stop).collect()
}

/// Microseconds per step, of the fastest round, and a checksum of the bits of all means.
fn run<T: Scalar>(threshold: f64) -> (f64, u64) {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
    let region = Region::new([T::ZERO; 2], [T::from_f64(3000.0); 2]).expect("a square");
    let channel = Channel::new(&Environment::urban(), T::from_f64(0.15)).expect("a channel");
    let settings =
        PublishedSettings { threshold: T::from_f64(threshold), ..PublishedSettings::thesis() };
    let mut filter = PublishedLocator::<T, PARTICLES>::new(channel, &region, settings, &mut rng);
    let measurements = circle::<T>();
    let (mut fastest, mut bits) = (f64::INFINITY, 0_u64);
    for _ in 0..ROUNDS {
        let start = Instant::now();
        for measurement in measurements.iter().cycle().take(LAPS * measurements.len()) {
            filter.measure(measurement, &mut rng).expect("a loss that particles explain");
            let moments = black_box(filter.moments());
            bits = bits.rotate_left(5) ^ moments.mean()[0].to_f64().to_bits();
        }
        let steps = (LAPS * measurements.len()) as f64;
        fastest = fastest.min(start.elapsed().as_secs_f64() * 1e6 / steps);
    }
    (fastest, bits)
}

fn main() {
    for (what, threshold) in [("a step", 0.1), ("always resampled", 2.0)] {
        let ((double, of_double), (single, of_single)) =
            (run::<f64>(threshold), run::<f32>(threshold));
        println!(
            "{what:16}  f64 {double:5.1} µs ({of_double:016x})  f32 {single:5.1} µs ({of_single:016x})"
        );
    }
}
