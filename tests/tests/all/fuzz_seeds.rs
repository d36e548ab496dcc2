//! Feeds the fuzz targets (`tests/fuzz`) with the bytes from which fuzzing begins: no reader and no tracker panics on them.
//! `.ci/fuzz` is the long form.

use std::fs;
use std::path::Path;

#[allow(unreachable_pub)] // Another package's library.
#[path = "../../fuzz/src/lib.rs"]
mod fuzz;

macro_rules! test_each {
    ($($name:ident)*) => {
        const TARGETS: &[&str] = &[$(stringify!($name)),*];

        $(#[test]
        fn $name() {
            let seeds = folder().join("seeds").join(stringify!($name));
            let seeds: Vec<_> = fs::read_dir(seeds).expect("seeds").collect();
            assert!(!seeds.is_empty());
            for seed in seeds {
                fuzz::$name::feed(&fs::read(seed.expect("a file").path()).expect("bytes"));
            }
        })*
    };
}

test_each!(
    drone flight_log gnss_observations gnss_products inertial_log level_log pedestrian range_log robot telemetry uav
);

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz"))
}

#[test]
fn every_target_is_fed() {
    let programs = fs::read_dir(folder().join("src/bin")).expect("programs");
    let stem = |path: &Path| path.file_stem().and_then(|stem| stem.to_str()).map(str::to_owned);
    let mut programs: Vec<_> =
        programs.filter_map(|program| stem(&program.expect("a program").path())).collect();
    programs.sort_unstable();
    assert_eq!(programs, TARGETS);
}
