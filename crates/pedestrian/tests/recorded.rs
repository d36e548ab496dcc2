//! Recorded walks in which the bus stalls: the six columns are zero for a while.
//!
//! The recordings stand beside the repository in `../shared/data/pedestrian`. Where they are absent this says
//! SKIPPED.

use kestirim_pedestrian::{
    Config, Ekf, Estimate, ImuSample, Lite, Navigator, OfflineTracker, Stride, Tracker, Warnings,
};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{SVector, Vector3};
use std::path::{Path, PathBuf};
use std::{env, fs};

const WALKS: [u32; 8] = [31, 36, 41, 46, 48, 57, 72, 81];
/// Lengths of the stall (µs).
const STALLS_US: [u64; 5] = [100_000, 200_000, 600_000, 2_000_000, 10_000_000];
/// Where it begins, in parts of the walk's duration.
const PLACES: [f64; 3] = [0.3, 0.45, 0.6];

/// Two runs see a stance end at slightly different times (µs).
const JITTER_US: u64 = 100_000;

fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/pedestrian/gcp");
    let folder =
        env::var_os("KESTIRIM_DATA").map_or(folder, |data| Path::new(&data).join("pedestrian/gcp"));
    if folder.is_dir() {
        return Some(folder);
    }
    let required = env::var("KESTIRIM_REQUIRE_DATA").is_ok_and(|value| value == "1");
    assert!(!required, "KESTIRIM_REQUIRE_DATA=1, but {} is absent", folder.display());
    eprintln!("SKIPPED: recordings: {} is absent", folder.display());
    None
}

fn read<T: Scalar>(file: &Path) -> Vec<ImuSample<T>> {
    let text = fs::read_to_string(file).unwrap();
    text.lines()
        .skip(1)
        .map(|line| {
            let v: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
            ImuSample {
                time_us: (v[0] * 1e6).round() as u64,
                specific_force: Vector3::new(v[1], v[2], v[3]).map(T::from_f64),
                angular_rate: Vector3::new(v[4], v[5], v[6]).map(T::from_f64),
            }
        })
        .collect()
}

struct Walked<T: Scalar> {
    strides: Vec<Stride<T>>,
    warnings: Warnings,
}

impl<T: Scalar> Walked<T> {
    /// The path of the strides that end up to one time and of those that end after another (m).
    fn path(&self, [until_us, from_us]: [u64; 2]) -> [f64; 2] {
        let sum = |within: &dyn Fn(u64) -> bool| {
            self.strides.iter().filter(|s| within(s.time_us)).map(|s| s.length.to_f64()).sum()
        };
        [sum(&|time_us| time_us <= until_us), sum(&|time_us| time_us > from_us)]
    }

    /// End of the last stride before a moment.
    fn last_before(&self, time_us: u64) -> u64 {
        self.strides
            .iter()
            .map(|s| s.time_us)
            .take_while(|t| t + JITTER_US < time_us)
            .last()
            .unwrap_or(0)
    }

    /// End of the first stride after a moment: that of a stall is not seen whole.
    fn first_after(&self, time_us: u64) -> Option<u64> {
        self.strides.iter().map(|s| s.time_us).find(|t| *t > time_us)
    }
}

fn finite<T: Scalar>(estimate: &Estimate<T>) -> bool {
    T::all_finite(estimate.position.as_slice())
        && T::all_finite(estimate.velocity.as_slice())
        && T::all_finite(&estimate.orientation.quaternion())
}

fn causal<T: Scalar, N: Navigator<T>>(samples: &[ImuSample<T>]) -> Walked<T> {
    let mut tracker = Tracker::<T, N>::new(Config::default());
    let mut strides = Vec::new();
    for sample in samples {
        let estimate = tracker.update(sample).unwrap();
        assert!(finite(&estimate), "{estimate:?}");
        strides.extend(estimate.stride);
    }
    strides.extend(tracker.finish());
    Walked { strides, warnings: tracker.warnings() }
}

fn offline<T: Scalar, N: Navigator<T>>(samples: &[ImuSample<T>]) -> Walked<T> {
    let mut memory = vec![T::ZERO; samples.len()];
    let mut tracker = OfflineTracker::<T, N>::new(Config::default(), samples, &mut memory).unwrap();
    let mut strides = Vec::new();
    for estimate in tracker.by_ref() {
        assert!(finite(&estimate), "{estimate:?}");
        strides.extend(estimate.stride);
    }
    strides.extend(tracker.finish());
    Walked { strides, warnings: tracker.warnings() }
}

/// The largest deviation of the path before and of that after a stall from the clean one (%).
fn stalls<T: Scalar>(
    walk: u32,
    folder: &Path,
    name: &str,
    track: fn(&[ImuSample<T>]) -> Walked<T>,
) -> f64 {
    let samples = read::<T>(&folder.join(format!("exp{walk}_imu.csv")));
    let clean = track(&samples);
    assert!(!clean.warnings.dropout && !clean.warnings.stuck && !clean.warnings.gaps);
    let end_us = samples.last().unwrap().time_us;
    let mut worst: f64 = 0.0;
    for stall_us in STALLS_US {
        for place in PLACES {
            let from_us = (place * end_us as f64) as u64;
            let until_us = from_us + stall_us;
            if until_us + 5_000_000 > end_us {
                continue;
            }
            let mut stalled = samples.clone();
            for sample in &mut stalled {
                if (from_us..until_us).contains(&sample.time_us) {
                    sample.specific_force = SVector::zeros();
                    sample.angular_rate = SVector::zeros();
                }
            }
            let walked = track(&stalled);
            assert!(walked.warnings.dropout, "walk {walk}, {stall_us} µs: not told");
            let found_us = walked.first_after(until_us).unwrap();
            assert!(
                found_us < until_us + 4_000_000,
                "walk {walk} {name}: found after {found_us} µs"
            );
            let around = [clean.last_before(from_us), found_us].map(|t| t + JITTER_US);
            let (got, reference) = (walked.path(around), clean.path(around));
            for (got, length) in got.into_iter().zip(reference) {
                if length > 0.0 {
                    let percent = (got / length - 1.0).abs() * 100.0;
                    if percent > 1.0 {
                        println!(
                            "walk {walk} {name}, {} s at {:.1} s: {got:.2} m of {length:.2} m",
                            stall_us as f64 * 1e-6,
                            from_us as f64 * 1e-6
                        );
                    }
                    worst = worst.max(percent);
                }
            }
        }
    }
    worst
}

#[test]
fn a_stalled_bus_leaves_the_path_before_and_after_as_it_is() {
    let Some(folder) = folder() else { return };
    for walk in WALKS {
        let worst = [
            stalls::<f32>(walk, &folder, "causal ekf f32", causal::<f32, Ekf<f32>>),
            stalls::<f32>(walk, &folder, "causal lite f32", causal::<f32, Lite<f32>>),
            stalls::<f32>(walk, &folder, "offline ekf f32", offline::<f32, Ekf<f32>>),
            stalls::<f32>(walk, &folder, "offline lite f32", offline::<f32, Lite<f32>>),
            stalls::<f64>(walk, &folder, "causal ekf f64", causal::<f64, Ekf<f64>>),
            stalls::<f64>(walk, &folder, "offline ekf f64", offline::<f64, Ekf<f64>>),
            stalls::<Q12_20>(walk, &folder, "causal ekf Q12.20", causal::<Q12_20, Ekf<Q12_20>>),
            stalls::<Q12_20>(walk, &folder, "causal lite Q12.20", causal::<Q12_20, Lite<Q12_20>>),
            stalls::<Q12_20>(walk, &folder, "offline ekf Q12.20", offline::<Q12_20, Ekf<Q12_20>>),
        ];
        println!("walk {walk}: worst {worst:.2?} %");
        assert!(worst.iter().all(|percent| *percent < 2.0), "walk {walk}: {worst:.2?} %");
    }
}
