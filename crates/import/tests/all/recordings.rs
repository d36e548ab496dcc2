//! The development recordings of walks, where they are available.

use std::fs;
use std::path::Path;

use kestirim_import::Options;
use kestirim_import::inertial;

use crate::plain;

/// The folders of the recordings: beside the working copy, or as CI has them.
const FOLDERS: [&str; 2] =
    ["../../../shared/data/pedestrian", "../../../../shared/data/pedestrian"];

/// All walks, with their names.
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

/// These parts do not begin with a still stand: the stance of a fast walk, in which the foot rolls, is not a rest that
/// shows the gyroscope's bias.
#[test]
fn parts_of_walks_are_read_and_swapped_axes_in_them_are_named() {
    const HEADER: &str = "t,ax,ay,az,gx,gy,gz";
    const PART_US: u64 = 20_000_000;
    let (mut parts, mut refused, mut named) = (0, Vec::new(), 0);
    for (name, bytes) in walks() {
        let log = plain::read(&bytes).expect(&name);
        for tenth in [2, 5, 8] {
            let first = log.samples.len() * tenth / 10;
            let begin = log.samples[first].time_us;
            let part = log.samples[first..].iter().take_while(|it| it.time_us < begin + PART_US);
            let part = plain::Log { samples: part.copied().collect(), truth: None };
            parts += 1;
            let right = written(&part, HEADER, |row| row);
            if let Err(error) = inertial::read(&right, &Options::default()) {
                refused.push(format!("{name} from {tenth} tenths on: {error}"));
            }
            let swapped =
                written(&part, HEADER, |[t, ax, ay, az, gx, gy, gz]| [t, ax, ay, az, gy, gx, -gz]);
            let answer = inertial::read(&swapped, &Options::default());
            named += usize::from(
                answer.is_err_and(|error| error.to_string().contains("fits as gy, gx, -gz")),
            );
        }
    }
    println!(
        "{parts} parts, {} refused: {refused:#?}; swapped axes named in {named}",
        refused.len()
    );
    assert!(refused.is_empty());
    assert!(named * 10 >= parts * 7, "{named} of {parts}");
}

/// A recording under a header, with `change` applied to each row.
fn written(log: &plain::Log, header: &str, change: impl Fn([f64; 7]) -> [f64; 7]) -> Vec<u8> {
    let mut text = format!("{header}\n");
    for sample in &log.samples {
        let ([ax, ay, az], [gx, gy, gz]) = (sample.specific_force, sample.angular_rate);
        let row = change([sample.time_us as f64 * 1e-6, ax, ay, az, gx, gy, gz]);
        text += &row.map(|value| format!("{value:.9}")).join(",");
        text.push('\n');
    }
    text.into_bytes()
}

#[test]
fn no_recording_is_read_wrong_in_other_units_or_axes() {
    const NAMED: &str = "time,AccX,AccY,AccZ,GyrX,GyrY,GyrZ";
    let degree = std::f64::consts::PI / 180.0;
    let (mut right, mut refused, mut swapped) = (0, Vec::new(), Vec::new());
    for (name, bytes) in walks() {
        let log = plain::read(&bytes).expect(&name);
        let other = written(&log, NAMED, |[t, ax, ay, az, gx, gy, gz]| {
            let [ax, ay, az] = [ax, ay, az].map(|x| x / kestirim_import::STANDARD_GRAVITY);
            [t * 1e3, ax, ay, az, gx / degree, gy / degree, gz / degree]
        });
        match inertial::read(&other, &Options::default()) {
            Ok(now) => {
                // Doubled samples may be left out.
                let (now, before) = (now.samples[now.samples.len() / 2], &log.samples);
                let same = before.iter().filter(|sample| sample.time_us.abs_diff(now.time_us) <= 1);
                let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 1e-6);
                let is_right = |sample: &&inertial::Sample| {
                    near(sample.specific_force, now.specific_force)
                        && near(sample.angular_rate, now.angular_rate)
                };
                assert!(same.into_iter().any(|sample| is_right(&sample)), "{name}: {now:?}");
                right += 1;
            }
            Err(error) => refused.push(format!("{name}: {error}")),
        }
        let mixed = written(&log, "t,ax,ay,az,gx,gy,gz", |[t, ax, ay, az, gx, gy, gz]| {
            [t, ax, ay, az, gy, gx, -gz]
        });
        if inertial::read(&mixed, &Options::default()).is_ok() {
            swapped.push(name);
        }
    }
    println!("{right} right, {} refused: {refused:#?}", refused.len());
    println!("swapped axes not seen in {}: {swapped:?}", swapped.len());
}
