//! Recorded walks with ground truth: the accuracy that the book promises, with one configuration for all.
//!
//! The recordings are in `../shared/data/pedestrian`, beside the repository. Where they are absent these tests print
//! SKIPPED and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each walk is printed.

use std::path::PathBuf;

use host_sim::metrics::{mean, median};
use host_sim::system::{AnySystem, Files, SettingValue, Settings, Source, Wanted};
use host_sim::systems::pedestrian::Pedestrian;
use host_sim::systems::pedestrian::recording::log;
use kestirim_replay::ScalarKind;
use kestirim_replay::pedestrian::{Options, SensorClass, TrackPoint, Walk, walk};
use kestirim_tests::recordings::{self, GCP, GCP_FAST, Group, gcp, vicon};

fn industrial(causal: bool) -> Options {
    Options { sensor: SensorClass::Industrial, causal, ..Options::default() }
}

#[test]
fn footprints_measured_with_a_ruler() {
    let Some(folder) = recordings::folder() else { return };
    let group = Group::track(gcp(&folder, &GCP), None, &industrial(false));
    assert!(mean(&group.path_errors) <= 0.8, "{:?}", group.path_errors);
    assert!(group.worst_path() <= 2.5, "{:?}", group.path_errors);
    assert!(median(&group.rmse_m) <= 0.45, "{:?}", group.rmse_m);
}

#[test]
fn the_same_without_looking_ahead() {
    let Some(folder) = recordings::folder() else { return };
    let group = Group::track(gcp(&folder, &GCP), None, &industrial(true));
    assert!(mean(&group.path_errors) <= 1.3, "{:?}", group.path_errors);
    assert!(group.worst_path() <= 4.0, "{:?}", group.path_errors);
}

#[test]
fn the_same_averaged_down_to_50_hz() {
    let Some(folder) = recordings::folder() else { return };
    let group = Group::track(gcp(&folder, &GCP), Some(50.0), &industrial(false));
    assert!(mean(&group.path_errors) <= 1.6, "{:?}", group.path_errors);
}

#[test]
fn fast_walks() {
    let Some(folder) = recordings::folder() else { return };
    for causal in [false, true] {
        let group = Group::track(gcp(&folder, &GCP_FAST), None, &industrial(causal));
        // Trackers that take the foot for motionless are known to lose 3 to 7 % here.
        assert!(group.worst_path() <= 2.5, "{:?}", group.path_errors);
    }
}

#[test]
fn walks_seen_by_cameras() {
    let Some(folder) = recordings::folder() else { return };
    let group = Group::track(vicon(&folder), None, &industrial(false));
    assert_eq!(group.rmse_m.len(), 9);
    assert!(median(&group.rmse_m) <= 0.085, "{:?}", group.rmse_m);
    assert!(group.worst_path() <= 5.0, "no walk is lost: {:?}", group.path_errors);
}

#[test]
fn smoothed_no_foot_jumps_as_it_lands() {
    let Some(folder) = recordings::folder() else { return };
    // The largest second difference of the track, m, from sample to sample.
    let jump = |walk: &Walk| {
        let places = walk.track.windows(3).map(|it| [it[0], it[1], it[2]].map(|it| it.position));
        let second = |[a, b, c]: [[f64; 3]; 3]| {
            let of = |axis: usize| c[axis] - 2.0 * b[axis] + a[axis];
            of(0).hypot(of(1)).hypot(of(2))
        };
        places.map(second).fold(0.0, f64::max)
    };
    let mut ratios = Vec::new();
    for (file, _) in vicon(&folder) {
        let recorded = log::read(&file, &log::Options::default()).expect("a walk");
        let tracked = |smooth| {
            let options = Options { smooth, ..industrial(false) };
            jump(&walk(&recorded.samples, &options).expect("a track"))
        };
        let (before, after) = (tracked(false), tracked(true));
        println!("{}: {:.1} mm, smoothed {:.1} mm", file.display(), 1e3 * before, 1e3 * after);
        ratios.push(after / before);
    }
    assert!(median(&ratios) < 0.1, "{ratios:?}");
    assert!(ratios.iter().all(|ratio| *ratio < 0.25), "{ratios:?}");
}

/// The report of a replay of these files, without a magnetometer, with or without assuming a walk along right angles.
fn report(given: &[(&str, PathBuf)], right_angles: bool) -> serde_json::Value {
    let mut files = Files::default();
    for (field, path) in given {
        files.add(*field, path);
    }
    let mut settings = Settings::new(AnySystem::settings(&Pedestrian));
    let switches = [("right-angles", right_angles), ("magnetometer", false)];
    settings.give(switches.map(|(name, is_on)| (name, SettingValue::Switch(is_on))).to_vec());
    let opened = Pedestrian.open(Source::Files(files), &settings).expect("a recording");
    opened.replay(&settings, &Wanted::default()).expect("a walk").report
}

/// Walks along a line and back, along rectangles, and around columns, whose headings hardly drift at 50 Hz: there
/// assuming right angles costs a tenth of a metre at most, in exp36 (there and back). Loops whose headings drift
/// improve.
#[test]
fn right_angles_correct_the_heading_where_there_are_some() {
    let Some(folder) = recordings::folder() else { return };
    for walk in [31, 36, 48, 57, 72, 81] {
        let [before, after] = [false, true].map(|right_angles| {
            let log = folder.join(format!("razor_format/exp{walk}_50Hz.txt"));
            let truth = folder.join(format!("gcp/exp{walk}_gcp.csv"));
            let report = report(&[("log", log), ("truth", truth)], right_angles);
            let rmse_m = report["accuracy"]["rmse_m"].as_f64().expect("footprints");
            (rmse_m, report["right_angles_share"].as_f64())
        });
        println!("exp{walk}: {:.3} m, with right angles {:.3} m, {:?}", before.0, after.0, after.1);
        // A short walk in one direction, and a crooked one.
        assert_eq!(after.1.is_none(), [48, 81].contains(&walk), "exp{walk}");
        if after.1.is_some() {
            assert!(after.0 < before.0 + 0.12, "exp{walk}");
        } else {
            assert_eq!(before.0.to_bits(), after.0.to_bits(), "exp{walk} has none and stays");
        }
    }
    let mut closures = [Vec::new(), Vec::new()];
    for loop_ in [31, 33, 36, 44] {
        let log = folder.join(format!("openshoe/Measurement_100521_{loop_}.csv"));
        for (closures, right_angles) in closures.iter_mut().zip([false, true]) {
            let report = report(&[("log", log.clone())], right_angles);
            closures.push(report["closure_m"].as_f64().expect("a loop"));
        }
    }
    println!("OpenShoe's loops close to {closures:?} m");
    assert!(mean(&closures[1]) < 0.7 * mean(&closures[0]), "{closures:?}");
}

#[test]
fn loops_of_a_bare_chip_close() {
    let Some(folder) = recordings::folder() else { return };
    let mut logs = 0;
    for entry in folder.join("mpu6050").read_dir().expect("the folder mpu6050") {
        let file = entry.expect("an entry").path();
        let Walk { path_length_m, closure_m, .. } = walk(
            &log::read(&file, &log::Options::default()).expect("a log").samples,
            &Options::default(),
        )
        .expect("a walk");
        println!("{}: path {path_length_m:.2} m, closure {closure_m:.3} m", file.display());
        assert!((path_length_m / 21.1 - 1.0).abs() <= 0.05, "{path_length_m} m of 21.1 m");
        assert!(closure_m <= 0.2, "{closure_m} m from the start");
        logs += 1;
    }
    assert_eq!(logs, 4);
}

/// The two logs of each pair are of the same foot: its stances coincide.
#[test]
fn two_sensors_on_one_walk_agree_and_those_of_two_walks_do_not() {
    let Some(folder) = recordings::folder() else { return };
    let logs =
        |walk: &str| [1, 2].map(|foot| folder.join(format!("mpu6050/{walk}_foot{foot}.csv")));
    let pairs = ["conf-1111-coleta03-14-06-21-10ds_03", "conf-3333-coleta04-02-06-21-5ds_03"];
    let pairs = pairs.map(logs);
    let closure_m = |report: &serde_json::Value| report["closure_m"].as_f64().expect("a loop");
    let (mut alone, mut together) = (Vec::new(), Vec::new());
    for [first, second] in &pairs {
        for (log, other) in [(first, second), (second, first)] {
            alone.push(closure_m(&report(&[("log", log.clone())], false)));
            let both = report(&[("log", log.clone()), ("other-foot", other.clone())], false);
            let [meetings, apart_m] = ["other_foot_meetings", "other_foot_apart_m"]
                .map(|name| both[name].as_f64().expect("two sensors"));
            println!("{meetings} meetings, {apart_m:.3} m apart");
            assert!(meetings > 15.0 && apart_m < 0.08, "{meetings}, {apart_m} m");
            together.push(closure_m(&both));
        }
    }
    println!("alone {alone:.2?} m, together {together:.2?} m");
    assert!(together.iter().all(|closure_m| *closure_m < 0.15), "{together:?}");
    let of_two_walks =
        report(&[("log", pairs[0][0].clone()), ("other-foot", pairs[1][1].clone())], false);
    assert!(of_two_walks["other_foot_meetings"].is_null(), "{of_two_walks}");
    assert_eq!(closure_m(&of_two_walks).to_bits(), alone[0].to_bits());
    let warnings = of_two_walks["warnings"].to_string();
    assert!(warnings.contains("the other foot is not used"), "{warnings}");
}

/// Errors over standard deviations, of all walks together and of each.
#[test]
fn standard_deviations_are_honest() {
    let Some(folder) = recordings::folder() else { return };
    let walks = [gcp(&folder, &GCP), gcp(&folder, &GCP_FAST), vicon(&folder)].concat();
    for causal in [false, true] {
        let group = Group::track(walks.clone(), None, &industrial(causal));
        let squares = group.rmse_m.iter().zip(&group.over_sigma);
        let [errors, sigmas] = squares.fold([0.0, 0.0], |[errors, sigmas], (rmse, over_sigma)| {
            [errors + rmse * rmse, sigmas + (rmse / over_sigma).powi(2)]
        });
        let together = (errors / sigmas).sqrt();
        println!("together {together:.2}, each {:.2?}", group.over_sigma);
        assert!((0.7..1.5).contains(&together), "{together}");
        assert!(group.over_sigma.iter().all(|ratio| *ratio < 2.5), "{:?}", group.over_sigma);
    }
}

/// A stalled bus delivers zeros, a full queue nothing: the path before and after is unaffected.
#[test]
fn a_walk_goes_on_after_stalls_and_gaps() {
    let Some(folder) = recordings::folder() else { return };
    for (log_file, _) in gcp(&folder, &GCP) {
        let samples = log::read(&log_file, &log::Options::default()).expect("a log").samples;
        let [first, last] = [0, samples.len() - 1].map(|index| samples[index].time_us);
        let middle = u64::midpoint(first, last);
        for (causal, scalar) in [
            (false, ScalarKind::F32),
            (false, ScalarKind::F64),
            (true, ScalarKind::F32),
            (true, ScalarKind::Fixed),
        ] {
            let options = Options { scalar, ..industrial(causal) };
            let clean = walk(&samples, &options).expect("a walk");
            for (seconds, is_gap) in [(0.1, false), (0.6, false), (10.0, false), (1.0, true)] {
                let end = middle + (seconds * 1e6) as u64;
                let mut faulty = samples.clone();
                if is_gap {
                    faulty.retain(|sample| !(middle..end).contains(&sample.time_us));
                }
                for sample in &mut faulty {
                    if (middle..end).contains(&sample.time_us) {
                        (sample.specific_force, sample.angular_rate) = ([0.0; 3], [0.0; 3]);
                    }
                }
                let faulty = walk(&faulty, &options).expect("a walk");
                let finite = |point: &TrackPoint| point.position.iter().all(|it| it.is_finite());
                assert!(faulty.track.iter().all(finite));
                // Three strides to notice and to align.
                let path = |walk: &Walk, from: u64, to: u64| -> f64 {
                    let inside = walk.strides.iter().filter(|it| (from..to).contains(&it.time_us));
                    inside.map(|stride| stride.length_m).sum()
                };
                let what = format!("{} {seconds} s, {options:?}", log_file.display());
                for (from, to) in [(0, middle - 1_000_000), (end + 3_000_000, u64::MAX)] {
                    let (with, without) = (path(&faulty, from, to), path(&clean, from, to));
                    let close = (with - without).abs() <= 0.02 * without + 0.01;
                    assert!(close, "{what}: {with} or {without} m");
                }
            }
        }
    }
}
