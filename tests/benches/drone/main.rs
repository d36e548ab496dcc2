//! Benchmarks the drone's filter on this machine against plain implementations of the same filter, in one run on one
//! thread:
//!
//! ```text
//! RUSTFLAGS="-C target-cpu=x86-64-v3" cargo bench -p kestirim-tests --bench drone
//! ```
//!
//! Without `RUSTFLAGS` it measures code for any x86-64; `cc` compiles plain C for the same processor. A number is the
//! processor time of the fastest of many rounds.

mod plain;

use std::hint::black_box;
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, ensure};
use host_sim::random::stream;
use host_sim::systems::drone::simulate::scenario::measure;
use host_sim::systems::drone::simulate::trajectory::{SIDE_M, Trajectory};
use kestirim_air_to_ground::Measurement;
use kestirim_particle_filter::{Region, Resampler, Xoshiro128PlusPlus, offspring};
use kestirim_replay::drone::EnvironmentKind;
use kestirim_scalar::Scalar;
use kestirim_user_locator::{PublishedLocator, PublishedSettings};
use rand_core::SeedableRng;
use rustix::time::{ClockId, clock_gettime};

/// The number of particles of a step.
const L: usize = 500;
/// The number of weights to resample.
const WEIGHTS: usize = 100_000;
/// The height of the drone, m.
const HEIGHT_M: f64 = 500.0;
/// The shares of effective particles below which a step resamples: the thesis' threshold, and one that always
/// resamples.
const THRESHOLDS: [f64; 2] = [0.1, 2.0];

const LAWS: [(Resampler, plain::Resample); 4] = [
    (Resampler::Systematic, plain::systematic),
    (Resampler::Stratified, plain::stratified),
    (Resampler::Residual, plain::residual),
    (Resampler::Multinomial, plain::multinomial),
];

/// The rows of the table: what is measured, published times and target times, µs. There are as many rows of steps as
/// thresholds, and as many other rows as resampling laws.
const ROWS: [[&str; 3]; 6] = [
    [
        "step, L = 500, with jitter",
        "C 39, C vectorised 11.9, multicalc 61, particles 128",
        "f64 20, f32 12",
    ],
    ["the same, always resampled", "", ""],
    ["systematic, 100 000", "C 1299, particles 1152", "400"],
    ["stratified", "", ""],
    ["residual", "C 3947, particles 2389", "1000"],
    ["multinomial", "C 10757, particles 1974", "1000"],
];

/// A measurement at one stop of the drone.
struct Stop {
    place: [f64; 2],
    loss: f64,
}

fn main() {
    let vectors = if cfg!(target_feature = "avx2") {
        "avx2"
    } else if cfg!(target_feature = "sse2") {
        "sse2"
    } else {
        "neither avx2 nor sse2"
    };
    println!("µs on one thread; target features: {vectors}");
    let stops = circle();
    let c = plain_c(&stops).unwrap_or_else(|error| {
        println!("no plain C: {error:#}");
        vec![]
    });
    let [double, single] = [ours::<f64>(&stops), ours::<f32>(&stops)];
    let rust = plain_rust(&stops);
    let line = |what, times: [&str; 4], published, target| {
        let [a, b, c, d] = times;
        println!("{what:27} {a:>8} {b:>8} {c:>8} {d:>10}  {target:14}  {published}");
    };
    line("", ["ours f64", "ours f32", "C -O3", "plain Rust"], "published", "target");
    for (row, [what, published, target]) in ROWS.into_iter().enumerate() {
        let time =
            |column: &[f64]| column.get(row).map_or(String::new(), |t| format!("{:.1}", t * 1e6));
        let times = [&double, &single, &c, &rust].map(|column| time(column));
        line(what, times.each_ref().map(String::as_str), published, target);
    }
}

/// Measurements from the thesis' circle around a user in the urban environment.
fn circle() -> Vec<Stop> {
    let (channel, mut rng) = (EnvironmentKind::Urban.channel(), stream(1, 0));
    let stop = |place| {
        let loss = measure(&channel, [1200.0, 900.0], place, HEIGHT_M, &mut rng);
        Stop { place, loss }
    };
    Trajectory::CIRCLE.points(12).into_iter().map(stop).collect()
}

fn ours<T: Scalar>(stops: &[Stop]) -> Vec<f64> {
    let number = T::from_f64;
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
    let region = Region::new([T::ZERO; 2], [number(SIDE_M); 2]).expect("a square");
    let measurement = |stop: &Stop| {
        Measurement::new(stop.place.map(number), number(HEIGHT_M), number(stop.loss))
            .expect("a place and a loss")
    };
    let measurements: Vec<_> = stops.iter().map(measurement).collect();
    let mut times = Vec::new();
    for threshold in THRESHOLDS {
        let settings =
            PublishedSettings { threshold: number(threshold), ..PublishedSettings::thesis() };
        let channel = EnvironmentKind::Urban.channel();
        let mut locator = PublishedLocator::<T, L>::new(channel, &region, settings, &mut rng);
        times.push(time_of_step(&measurements, |measurement| {
            locator.measure(measurement, &mut rng).expect("a loss that particles explain");
            black_box(locator.moments());
        }));
    }
    let weights: Vec<T> = weights().into_iter().map(number).collect();
    let mut counts = vec![0; WEIGHTS];
    for (law, _) in LAWS {
        times.push(fastest(50, || {
            offspring(law, &weights, &mut counts, &mut rng).expect("weights");
            black_box(&counts);
        }));
    }
    times
}

fn plain_rust(stops: &[Stop]) -> Vec<f64> {
    let mut times = Vec::new();
    for threshold in THRESHOLDS {
        let mut filter = plain::Filter::new(threshold);
        times.push(time_of_step(stops, |stop| {
            black_box(filter.step(stop));
        }));
    }
    let (weights, mut ancestors, mut rng) = (weights(), vec![0; WEIGHTS], plain::Random::new());
    for (_, resample) in LAWS {
        times.push(fastest(50, || {
            resample(&weights, &mut ancestors, &mut rng);
            black_box(&ancestors);
        }));
    }
    times
}

/// Compiles `plain.c` and runs it.
fn plain_c(stops: &[Stop]) -> anyhow::Result<Vec<f64>> {
    let folder = tempfile::tempdir()?;
    let program = folder.path().join("plain");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/drone/plain.c");
    let architecture = cfg!(target_feature = "avx2").then_some("-march=x86-64-v3");
    let compiled = Command::new("cc")
        .args(["-std=c11", "-O3"])
        .args(architecture)
        .args([source, "-lm", "-o"])
        .arg(&program)
        .status()
        .context("no cc to compile it with")?;
    ensure!(compiled.success(), "cc: {compiled}");
    let numbers = stops.iter().flat_map(|stop| [stop.place[0], stop.place[1], stop.loss]);
    let output = Command::new(program).args(numbers.map(|number| number.to_string())).output()?;
    ensure!(output.status.success(), "it failed: {}", output.status);
    let times = String::from_utf8(output.stdout)?;
    times.split_whitespace().map(|time| Ok(time.parse()?)).collect()
}

/// Squares of uniform numbers, normalised to sum one: most are small, none are large.
fn weights() -> Vec<f64> {
    let mut rng = plain::Random::new();
    let weights: Vec<f64> = (0..WEIGHTS).map(|_| rng.uniform().powi(2)).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

/// The time of one step, measured over several laps, s.
fn time_of_step<M>(measurements: &[M], mut step: impl FnMut(&M)) -> f64 {
    let laps = || std::iter::repeat_n(measurements, 4).flatten();
    fastest(200, || laps().for_each(&mut step)) / laps().count() as f64
}

/// The processor time of the fastest round, s.
fn fastest(rounds: usize, mut work: impl FnMut()) -> f64 {
    let now = || Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default();
    let round = |_| {
        let begin = now();
        work();
        now().saturating_sub(begin).as_secs_f64()
    };
    (0..rounds).map(round).fold(f64::INFINITY, f64::min)
}
