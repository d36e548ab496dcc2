//! Tests of the program: exit status, standard output, standard error, files.

use std::fs;
use std::path::Path;

use host_sim::random::stream;
use host_sim::systems::pedestrian::Sample;
use host_sim::systems::pedestrian::simulate::scenario::Scenario;
use host_sim::systems::pedestrian::simulate::sensor::razor_text;
use kestirim_replay::pedestrian::Footprint;

use crate::program::{Desk, host_sim, json, refusal, rows_of, text};

const HEADER: &str = "t,ax,ay,az,gx,gy,gz\n";

/// A synthetic walk without noise, as CSV, and its footprints.
fn walk_and_footprints() -> (String, String) {
    let scenario = Scenario::draw(&mut stream(1, 0));
    let row = |sample: Sample| {
        let ([ax, ay, az], [gx, gy, gz]) = (sample.specific_force, sample.angular_rate);
        let t = sample.time_us as f64 / 1e6;
        format!("{t:.6},{ax:.6},{ay:.6},{az:.6},{gx:.6},{gy:.6},{gz:.6}\n")
    };
    let log =
        HEADER.to_owned() + &scenario.ideal_imu(100.0).into_iter().map(row).collect::<String>();
    let row = |footprint: Footprint| {
        let (t, [x, y]) = (footprint.time_us as f64 / 1e6, footprint.position);
        format!("{},{t:.6},{x:.4},{y:.4}\n", footprint.time_us / 10_000)
    };
    let footprints: String = scenario.footprints().into_iter().map(row).collect();
    let footprints = "sample_index,t,x,y\n".to_owned() + &footprints;
    (log, footprints)
}

#[test]
fn a_walk_is_replayed_as_json_and_as_a_table() {
    let desk = Desk::new();
    let (log, footprints) = walk_and_footprints();
    let (log, truth) = (desk.file("walk.csv", &log), desk.file("feet.csv", &footprints));
    let arguments = ["replay", "pedestrian", "--log", &log, "--truth", &truth];
    let report = json(&host_sim(&[&arguments[..], &["--json"]].concat()));
    assert_eq!(report["system"], "pedestrian");
    for number in ["samples", "duration_s", "path_length_m", "closure_m"] {
        assert!(report[number].is_number(), "{number}");
    }
    for number in ["rmse_m", "final_error_m", "final_error_percent", "path_length_error_percent"] {
        assert!(report["accuracy"][number].is_number(), "{number}");
    }
    assert!(report["warnings"].is_array());
    let strides = report["strides"].as_array().expect("strides");
    assert!(!strides.is_empty());
    for number in ["t", "x", "y", "z", "length_m"] {
        assert!(strides[0][number].is_number(), "{number}");
    }
    let table = host_sim(&arguments);
    assert!(text(&table.stdout).contains("path length"));
}

#[test]
fn without_truth_accuracy_is_null_and_truth_columns_count_as_truth() {
    let desk = Desk::new();
    let (log, _) = walk_and_footprints();
    let bare = desk.file("walk.csv", &log);
    let arguments = ["replay", "pedestrian", "--json", "--log"];
    assert!(json(&host_sim(&[&arguments[..], &[&bare]].concat()))["accuracy"].is_null());
    let rows = log.lines().skip(1).map(|row| format!("{row},0,0,0\n"));
    let with_truth =
        rows.fold(format!("{},gt_x,gt_y,gt_z\n", HEADER.trim()), |all, row| all + &row);
    let with_truth = desk.file("truth.csv", with_truth);
    assert!(json(&host_sim(&[&arguments[..], &[&with_truth]].concat()))["accuracy"].is_object());
}

#[test]
fn the_track_has_a_row_for_every_sample() {
    let desk = Desk::new();
    let scenario = Scenario::draw(&mut stream(1, 0));
    let samples = scenario.ideal_imu(100.0);
    let log = desk.file("walk.txt", razor_text(&samples));
    let track = desk.named("track.csv");
    let arguments = ["replay", "pedestrian", "--json", "--log", &log, "--track", &track];
    for (extra, expected) in
        [(&[][..], samples.len()), (&["--rate", "50"], samples.len().div_ceil(2))]
    {
        let report = json(&host_sim(&[&arguments[..], extra].concat()));
        assert_eq!(report["samples"], expected);
        let (header, rows) = rows_of::<7>(&track);
        assert_eq!(header, "t,x,y,z,sx,sy,sz,health");
        assert_eq!(rows.len(), expected);
        assert!(rows.iter().all(|(numbers, health)| health == "good" && numbers[4] > 0.0));
    }
    assert_eq!(fs::read_dir(desk.path(".")).expect("the folder is there").count(), 2);
}

#[test]
fn broken_logs_are_refused_with_file_and_line() {
    let desk = Desk::new();
    let row = "0.00,0,0,9.8,0,0,0\n";
    for (name, contents, line) in [
        ("text.csv", format!("{HEADER}{row}0.01,0,0,up,0,0,0\n"), "line 3:"),
        ("nan.csv", format!("{HEADER}{row}0.01,0,0,NaN,0,0,0\n"), "line 3:"),
        ("inf.csv", format!("{HEADER}{row}0.01,0,0,inf,0,0,0\n"), "line 3:"),
        ("force.csv", format!("{HEADER}{row}0.01,0,0,9999,0,0,0\n"), "line 3:"),
        ("rate.csv", format!("{HEADER}{row}0.01,0,0,9,0,0,1800\n"), "line 3:"),
        ("back.csv", format!("{HEADER}{row}0.02,0,0,9,0,0,0\n0.01,0,0,9,0,0,0\n"), "line 4:"),
        ("cut.csv", format!("{HEADER}{row}0.01,0,0,9"), "line 3:"),
        ("column.csv", "t,ax,ay,az,gx,gy\n0,0,0,0,0,0\n".to_owned(), "column gz"),
        ("garbage.txt", "\0\u{7}\u{1b}[31m\n\0\n".to_owned(), "a table of numbers"),
        ("empty.csv", String::new(), "empty"),
        ("header.csv", HEADER.to_owned(), "a table of numbers"),
    ] {
        let log = desk.file(name, contents);
        let sentence = refusal(&["replay", "pedestrian", "--json", "--strict", "--log", &log]);
        assert!(sentence.contains(name) && sentence.contains(line), "{sentence}");
    }
    let bytes = desk.file("bytes.csv", b"t,ax\n\xff\xfe\n");
    assert!(refusal(&["replay", "pedestrian", "--log", &bytes]).contains("bytes.csv: expected"));
}

/// A last line cut by the power switch, and a bit lost on a wire: the rest of the walk is read.
#[test]
fn damaged_lines_are_skipped_and_told() {
    let desk = Desk::new();
    let (log, _) = walk_and_footprints();
    let replay = |name, text: &str| {
        let log = desk.file(name, text);
        json(&host_sim(&["replay", "pedestrian", "--json", "--log", &log]))
    };
    let whole = replay("whole.csv", &log);
    let lines: Vec<_> = log.lines().collect();
    let mut damaged = lines.clone();
    damaged[100] = "8.1,0,0,NaN,0,0,0";
    let cut = &lines[lines.len() - 1][..7];
    *damaged.last_mut().unwrap() = cut;
    let found = replay("damaged.csv", &damaged.join("\n"));
    let warnings = found["warnings"].to_string();
    assert!(warnings.contains("line 101") && warnings.contains("cut"), "{warnings}");
    let length = |of: &serde_json::Value| of["path_length_m"].as_f64().unwrap();
    assert!((length(&found) / length(&whole) - 1.0).abs() < 0.005, "{found} {whole}");
}

/// Units and columns that a person recognises at a glance are inferred, and the conclusions are reported.
#[test]
fn units_and_columns_are_found_or_said() {
    let desk = Desk::new();
    let (log, _) = walk_and_footprints();
    let written = |header: &str, separator: &str, scales: [f64; 3]| {
        let mut text = format!("{header}\n");
        for line in log.lines().skip(1) {
            let fields = line.split(',').enumerate().map(|(column, field)| {
                let scale = scales[[0, 1, 1, 1, 2, 2, 2][column]];
                (field.parse::<f64>().unwrap() * scale).to_string()
            });
            text += &fields.collect::<Vec<_>>().join(separator);
            text.push('\n');
        }
        text
    };
    let replay = |name, text: String, more: &[&str]| {
        let log = desk.file(name, text);
        json(&host_sim(&[&["replay", "pedestrian", "--json", "--log", &log], more].concat()))
    };
    let degrees = 180.0 / std::f64::consts::PI;
    let plain = replay("plain.csv", log.clone(), &[]);
    let names = "time [ms]\taccX [g]\taccY [g]\taccZ [g]\tgyrX [deg/s]\tgyrY [deg/s]\tgyrZ [deg/s]";
    let scales = [1e3, 1.0 / 9.806_65, degrees];
    let named = replay("named.tsv", written(names, "\t", scales), &[]);
    let bare = written("c1,c2,c3,c4,c5,c6,c7", ",", scales);
    let said = replay(
        "said.csv",
        bare,
        &[
            "--columns",
            "t=c1,ax=c2,ay=c3,az=c4,gx=c5,gy=c6,gz=c7",
            "--units",
            "acc=g,gyro=deg/s,t=ms",
        ],
    );
    for found in [named, said] {
        let length = |of: &serde_json::Value| of["path_length_m"].as_f64().unwrap();
        assert!((length(&found) / length(&plain) - 1.0).abs() < 1e-3, "{found} {plain}");
        assert!(found["import"].to_string().contains("acceleration in g"), "{found}");
        assert_eq!(found["warnings"], plain["warnings"]);
    }
}

#[test]
fn unreadable_files_are_refused() {
    let desk = Desk::new();
    let folder = desk.named("");
    let log = desk.file("walk.csv", walk_and_footprints().0);
    let missing = desk.named("missing.csv");
    assert!(refusal(&["replay", "pedestrian", "--log", &missing]).contains("missing.csv"));
    refusal(&["replay", "pedestrian", "--log", &folder]);
    refusal(&["replay", "pedestrian", "--log", &log, "--truth", &missing]);
    let late = desk.file("late.csv", "t,x,y\n1,0,0\n999,1,0\n");
    let sentence = refusal(&["replay", "pedestrian", "--log", &log, "--truth", &late]);
    assert!(sentence.contains("late.csv: expected at least two footprints"), "{sentence}");
}

#[test]
fn an_unwritable_track_is_refused_before_anything_is_printed() {
    let desk = Desk::new();
    let (contents, _) = walk_and_footprints();
    let log = desk.file("walk.csv", &contents);
    for track in [desk.named("no/track.csv"), desk.named(""), log.clone()] {
        refusal(&["replay", "pedestrian", "--log", &log, "--track", &track]);
    }
    assert_eq!(fs::read_to_string(Path::new(&log)).expect("still there"), contents);
}

#[test]
fn short_logs_never_panic() {
    let desk = Desk::new();
    for rows in [1, 2, 3, 20] {
        let row = |i| format!("{}.0,0,0,9.8,0,0,0\n", i / 3);
        let log = desk
            .file("short.csv", (0..rows).map(row).fold(HEADER.to_owned(), |all, row| all + &row));
        let status =
            host_sim(&["replay", "pedestrian", "--log", &log, "--rate", "1"]).status.code();
        assert!(matches!(status, Some(0 | 2)), "{rows} rows: {status:?}");
    }
}

#[test]
fn wrong_usage_is_one_sentence() {
    let desk = Desk::new();
    let log = desk.file("walk.csv", walk_and_footprints().0);
    for arguments in [
        &["dance"][..],
        &["run"],
        &["run", "submarine"],
        &["run", "pedestrian", "--scalar", "f16"],
        &["run", "pedestrian", "--trials", "0"],
        &["replay", "pedestrian"],
        &["replay", "pedestrian", "--log", &log, "--detector", "glrt"],
        &["replay", "pedestrian", "--log", &log, "--detector", "shoe:-1"],
        &["replay", "pedestrian", "--log", &log, "--rate", "400"],
        &["replay", "pedestrian", "--log", &log, "--rate", "nan"],
        &["replay", "pedestrian", "--log", &log, "--rate", "-5"],
    ] {
        refusal(arguments);
    }
}

#[test]
fn an_experiment_is_one_json_object_that_repeats() {
    let arguments = ["run", "pedestrian", "--trials", "1", "--seed", "5", "--json"];
    let report = json(&host_sim(&arguments));
    assert_eq!(report["rows"][0]["published"]["mean_relative_error_percent"], 4.74);
    assert_eq!(report["rows"][1]["ours"]["walks"], 7);
    assert_eq!(report, json(&host_sim(&arguments)));
}

#[test]
fn systems_are_listed() {
    let output = host_sim(&["list"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stdout).contains("pedestrian"));
    assert_eq!(host_sim(&["--help"]).status.code(), Some(0));
    assert_eq!(host_sim(&["--version"]).status.code(), Some(0));
}
