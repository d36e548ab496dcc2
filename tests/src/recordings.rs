//! Recorded walks with ground truth, from `../shared/data/pedestrian` beside the repository.

use std::env;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use host_sim::systems::pedestrian::account::accuracy::against_footprints;
use host_sim::systems::pedestrian::recording::{log, resample, truth};
use kestirim_replay::pedestrian::{Options, walk};

/// The walks at ordinary speed whose footprints were measured with a ruler.
pub const GCP: [u32; 8] = [31, 36, 41, 46, 48, 57, 72, 81];
/// The fast walks whose footprints were measured with a ruler.
pub const GCP_FAST: [u32; 3] = [43, 56, 74];

/// The folder of the recorded walks.
///
/// # Panics
/// As [`folder_of`].
pub fn folder() -> Option<PathBuf> {
    folder_of("pedestrian")
}

/// The folder of a system's recordings.
///
/// Where it is absent, prints a notice and returns `None`, or panics with `KESTIRIM_REQUIRE_DATA=1`.
///
/// # Panics
/// See above.
pub fn folder_of(system: &str) -> Option<PathBuf> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = data.join(system);
    if folder.is_dir() {
        return Some(folder);
    }
    let required = env::var("KESTIRIM_REQUIRE_DATA").is_ok_and(|value| value == "1");
    assert!(!required, "KESTIRIM_REQUIRE_DATA=1, but {} is absent", folder.display());
    // Not `eprintln!`, which the test runner swallows when the test passes.
    let _ = writeln!(io::stderr(), "SKIPPED: recordings: {} is absent", folder.display());
    None
}

/// The results of a group of walks.
#[derive(Clone, Debug)]
pub struct Group {
    /// The absolute error of each path length, %.
    pub path_errors: Vec<f64>,
    /// The RMSE of each walk's footprints, m.
    pub rmse_m: Vec<f64>,
    /// The RMSE of each walk's footprints over its root mean square standard deviation.
    pub over_sigma: Vec<f64>,
}

impl Group {
    /// Tracks walks given as log and truth, averaged down to a rate if one is given, and prints each.
    ///
    /// # Panics
    /// A recording cannot be read: those beside the repository can.
    pub fn track(
        walks: impl IntoIterator<Item = (PathBuf, PathBuf)>,
        rate_hz: Option<f64>,
        options: &Options,
    ) -> Self {
        let mut group =
            Self { path_errors: Vec::new(), rmse_m: Vec::new(), over_sigma: Vec::new() };
        for (log_file, truth_file) in walks {
            let mut log =
                log::read(&log_file, &log::Options::default()).expect("a recording can be read");
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
            group.over_sigma.push(accuracy.error_over_sigma.expect("a standard deviation"));
        }
        group
    }

    /// The largest error of a path length, %.
    pub fn worst_path(&self) -> f64 {
        self.path_errors.iter().copied().fold(0.0, f64::max)
    }
}

/// The logs and truths of the walks over measured footprints.
pub fn gcp(folder: &Path, experiments: &[u32]) -> Vec<(PathBuf, PathBuf)> {
    let file = |number, kind| folder.join(format!("gcp/exp{number}_{kind}.csv"));
    experiments.iter().map(|&number| (file(number, "imu"), file(number, "gcp"))).collect()
}

/// The logs and truths of the walks recorded by cameras.
///
/// # Panics
/// Their folder is absent.
pub fn vicon(folder: &Path) -> Vec<(PathBuf, PathBuf)> {
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
