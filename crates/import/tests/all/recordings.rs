//! The development recordings of walks, where they are at hand.

use std::fs;
use std::path::Path;

use kestirim_import::Options;
use kestirim_import::inertial;

use crate::plain;

/// Where the recordings are, beside the working copy or as CI has them.
const FOLDERS: [&str; 2] =
    ["../../../shared/data/pedestrian", "../../../../shared/data/pedestrian"];

/// All walks, by name.
pub(crate) fn walks() -> Vec<(String, Vec<u8>)> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let Some(folder) = FOLDERS.iter().map(|at| here.join(at)).find(|at| at.is_dir()) else {
        println!("SKIPPED: no recordings of walks in {}", here.join(FOLDERS[0]).display());
        return Vec::new();
    };
    let mut walks = Vec::new();
    for family in fs::read_dir(folder).expect("a folder of families") {
        let family = family.expect("a family").path();
        for file in fs::read_dir(&family).expect("a family's recordings") {
            let path = file.expect("a recording").path();
            let name = format!(
                "{}/{}",
                family.file_name().unwrap_or_default().display(),
                path.file_name().unwrap_or_default().display()
            );
            let is_truth = name.ends_with("_gcp.csv") || name.ends_with("_strides.csv");
            if !is_truth {
                walks.push((name, fs::read(&path).expect("a recording that can be read")));
            }
        }
    }
    walks.sort();
    walks
}

#[test]
fn plain_recordings_are_read_as_before() {
    for (name, bytes) in walks() {
        let before = plain::read(&bytes).expect(&name);
        let now = inertial::read(&bytes, &Options::default())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(now.samples.len(), before.samples.len(), "{name}");
        let first = (0..now.samples.len()).find(|&i| now.samples[i] != before.samples[i]);
        assert_eq!(first, None, "{name}: the first sample that differs");
        assert_eq!(now.damage.count(), 0, "{name}: {:?}", now.damage);
        if let Some(truth) = before.truth {
            let columns = ["gt_x", "gt_y", "gt_z"].map(|axis| now.column(axis).expect("truth"));
            let same = |(i, point): (usize, &[f64; 3])| *point == columns.map(|column| column[i]);
            assert!(truth.iter().enumerate().all(same), "{name}: truth");
        }
        let told: Vec<_> = now.conclusions.iter().map(ToString::to_string).collect();
        println!("{name}: {}", told.join("; "));
    }
}
