//! Recorded walks with truth: the accuracy that the book promises, one configuration for all.
//!
//! The recordings stand beside the repository in `../shared/data/pedestrian`. Where they are absent these
//! tests say SKIPPED and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each walk
//! is printed.

use std::env;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use host_sim::metrics::{mean, median};
use host_sim::systems::pedestrian::accuracy::against_footprints;
use host_sim::systems::pedestrian::options::{Options, SensorClass};
use host_sim::systems::pedestrian::run::{Walk, walk};
use host_sim::systems::pedestrian::{log, resample, truth};

/// The walks with measured footprints that are not fast …
const GCP: [u32; 8] = [31, 36, 41, 46, 48, 57, 72, 81];
/// … and those that are.
const GCP_FAST: [u32; 3] = [43, 56, 74];

/// The folder of the recordings, if it is there.
fn recordings() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/pedestrian");
    if folder.is_dir() {
        return Some(folder);
    }
    let required = env::var("KESTIRIM_REQUIRE_DATA").is_ok_and(|value| value == "1");
    assert!(!required, "KESTIRIM_REQUIRE_DATA=1, but {} is absent", folder.display());
    // Not `eprintln!`, which the test runner swallows when the test passes.
    let _ = writeln!(io::stderr(), "SKIPPED: recorded walks: {} is absent", folder.display());
    None
}

/// How a group of walks came out.
struct Group {
    /// |error| of each path length, %.
    path_errors: Vec<f64>,
    rmse_m: Vec<f64>,
}

impl Group {
    fn track(
        walks: impl IntoIterator<Item = (PathBuf, PathBuf)>,
        rate_hz: Option<f64>,
        options: &Options,
    ) -> Self {
        let mut group = Self { path_errors: Vec::new(), rmse_m: Vec::new() };
        for (log_file, truth_file) in walks {
            let mut log = log::read(&log_file).expect("a recording can be read");
            let footprints = truth::read(&truth_file, &log).expect("a truth can be read");
            if let Some(rate_hz) = rate_hz {
                log = resample::average_down(&log, rate_hz).expect("a lower rate");
            }
            let walk = walk(&log.samples, options).expect("a walk");
            let accuracy = against_footprints(&walk, &footprints);
            let error = accuracy.path_length_error_percent.expect("the walker moved");
            let name = log_file.file_name().unwrap_or_default().display();
            println!("{name}: path {error:+.2} %, RMSE {:.3} m", accuracy.rmse_m);
            group.path_errors.push(error.abs());
            group.rmse_m.push(accuracy.rmse_m);
        }
        group
    }

    fn worst_path(&self) -> f64 {
        self.path_errors.iter().copied().fold(0.0, f64::max)
    }
}

fn gcp(folder: &Path, experiments: &[u32]) -> Vec<(PathBuf, PathBuf)> {
    let file = |number, kind| folder.join(format!("gcp/exp{number}_{kind}.csv"));
    experiments.iter().map(|&number| (file(number, "imu"), file(number, "gcp"))).collect()
}

fn vicon(folder: &Path) -> Vec<(PathBuf, PathBuf)> {
    let entries = folder.join("vicon").read_dir().expect("the folder vicon");
    let mut walks: Vec<_> = entries
        .filter_map(|entry| {
            let truth_file = entry.ok()?.path();
            let name = truth_file.file_name()?.to_str()?.strip_suffix("_strides.csv")?.to_owned();
            Some((truth_file.with_file_name(format!("{name}.csv")), truth_file))
        })
        .collect();
    walks.sort();
    walks
}

fn industrial(causal: bool) -> Options {
    Options { sensor: SensorClass::Industrial, causal, ..Options::default() }
}

#[test]
fn footprints_measured_with_a_ruler() {
    let Some(folder) = recordings() else { return };
    let group = Group::track(gcp(&folder, &GCP), None, &industrial(false));
    assert!(mean(&group.path_errors) <= 0.8, "{:?}", group.path_errors);
    assert!(group.worst_path() <= 2.5, "{:?}", group.path_errors);
    assert!(median(&group.rmse_m) <= 0.45, "{:?}", group.rmse_m);
}

#[test]
fn the_same_without_looking_ahead() {
    let Some(folder) = recordings() else { return };
    let group = Group::track(gcp(&folder, &GCP), None, &industrial(true));
    assert!(mean(&group.path_errors) <= 1.3, "{:?}", group.path_errors);
    assert!(group.worst_path() <= 4.0, "{:?}", group.path_errors);
}

#[test]
fn the_same_averaged_down_to_50_hz() {
    let Some(folder) = recordings() else { return };
    let group = Group::track(gcp(&folder, &GCP), Some(50.0), &industrial(false));
    assert!(mean(&group.path_errors) <= 1.6, "{:?}", group.path_errors);
}

#[test]
fn fast_walks() {
    let Some(folder) = recordings() else { return };
    for causal in [false, true] {
        let group = Group::track(gcp(&folder, &GCP_FAST), None, &industrial(causal));
        // Trackers that take the foot for motionless are known to lose 3 to 7 % here.
        assert!(group.worst_path() <= 2.5, "{:?}", group.path_errors);
    }
}

#[test]
fn walks_seen_by_cameras() {
    let Some(folder) = recordings() else { return };
    let group = Group::track(vicon(&folder), None, &industrial(false));
    assert_eq!(group.rmse_m.len(), 9);
    assert!(median(&group.rmse_m) <= 0.085, "{:?}", group.rmse_m);
    assert!(group.worst_path() <= 5.0, "no walk is lost: {:?}", group.path_errors);
}

#[test]
fn loops_of_a_bare_chip_close() {
    let Some(folder) = recordings() else { return };
    let mut logs = 0;
    for entry in folder.join("mpu6050").read_dir().expect("the folder mpu6050") {
        let file = entry.expect("an entry").path();
        let Walk { path_length_m, closure_m, .. } =
            walk(&log::read(&file).expect("a log").samples, &Options::default()).expect("a walk");
        println!("{}: path {path_length_m:.2} m, closure {closure_m:.3} m", file.display());
        assert!((path_length_m / 21.1 - 1.0).abs() <= 0.05, "{path_length_m} m of 21.1 m");
        assert!(closure_m <= 0.2, "{closure_m} m from the start");
        logs += 1;
    }
    assert_eq!(logs, 4);
}
