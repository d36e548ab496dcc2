//! Tests of the robot's commands.

use std::fmt::Write;
use std::fs;

use crate::program::{Desk, host_sim, json, refusal, rows_of, text};
use crate::room::{ANCHORS, Room, distance, line, place};
use host_sim::random::{normal, stream};
use serde_json::Value;

#[test]
fn a_recording_is_replayed_as_json_and_as_a_table() {
    let room = Room::clean();
    let report = room.report(&["--height", "1"]);
    assert_eq!(report["system"], "robot");
    assert_eq!((report["updates"].as_u64(), report["rejected"].as_u64()), (Some(1600), Some(0)));
    assert_eq!(report["lost_s"], 0.0);
    assert_eq!(report["warnings"], Value::Array(vec![]));
    assert!(report["accuracy"]["rmse_m"].as_f64().unwrap() < 0.1, "{report}");
    assert_eq!(report["accuracy"]["missed"], 0);
    let table = host_sim(&room.replay(&["--height", "1"]));
    assert!(text(&table.stdout).contains("ranges taken in"));
    assert_eq!(
        json(&host_sim(&room.replay(&["--height", "1", "--json"])))["accuracy"],
        Value::Null
    );
}

#[test]
fn every_tracker_follows_in_every_number() {
    let room = Room::clean();
    for tracker in ["lsq", "nls", "ekf", "aekf", "default"] {
        for scalar in ["f32", "f64", "fixed"] {
            let rmse = room.rmse(&["--height", "1", "--tracker", tracker, "--scalar", scalar]);
            assert!(rmse < 0.12, "{tracker} {scalar}: {rmse}");
        }
    }
    // As printed, the paper's filter stays behind at its start.
    assert!(room.rmse(&["--height", "1", "--tracker", "aekf-printed"]) > 0.3);
}

#[test]
fn the_track_has_a_row_for_every_epoch() {
    let room = Room::clean();
    let track = room.desk.named("track.csv");
    assert!(host_sim(&room.replay(&["--height", "1", "--track", &track])).status.success());
    let (header, rows) = rows_of::<6>(&track);
    assert_eq!(header, "t,x,y,z,sx,sy,sz,health");
    assert_eq!(rows.len(), 400);
    let ([t, found_x, found_y, z, sx, sy], health) = &rows[399];
    assert!((t - 39.9).abs() < 1e-9 && *z == 1.0 && health == "good");
    let [x, y] = place(39.9);
    assert!((found_x - x).hypot(found_y - y) < 0.15);
    assert!([sx, sy].iter().all(|sigma| (0.001..0.5).contains(*sigma)), "{sx} {sy}");
}

#[test]
fn a_smoothed_track_stands_beside_the_trackers_and_in_the_file() {
    let room = Room::clean();
    let track = room.desk.named("track.csv");
    let report = room.report(&["--height", "1", "--smooth", "--track", &track]);
    let rmse = |of: &Value| of["accuracy"]["rmse_m"].as_f64().unwrap();
    assert!(rmse(&report["smoothed"]) < rmse(&report), "{report}");
    assert_eq!(report["smoothed"]["anchors"].as_array().map(Vec::len), Some(4));
    let (header, rows) = rows_of::<6>(&track);
    assert_eq!((header.as_str(), rows.len()), ("t,x,y,z,sx,sy,sz,health", 400));
    let plain = room.desk.named("plain.csv");
    let report = room.report(&["--height", "1", "--track", &plain]);
    assert_eq!(report.get("smoothed"), None);
    assert_ne!(rows_of::<6>(&plain).1, rows);
}

#[test]
fn a_room_on_a_map_is_followed_like_one_at_the_origin() {
    let room = Room::clean();
    let [east, north] = [512_345.0, 5_412_345.0];
    let on_the_map = ANCHORS.iter().enumerate().fold("anchor,x,y,z\n".to_owned(), |text, it| {
        let (index, [x, y, z]) = it;
        text + &format!("A{index},{},{},{z}\n", x + east, y + north)
    });
    let anchors = room.desk.file("map.csv", on_the_map);
    let (near, far) = (room.desk.named("near.csv"), room.desk.named("far.csv"));
    for scalar in ["f32", "f64", "fixed"] {
        let options = ["--height", "1", "--scalar", scalar];
        host_sim(&room.replay(&[&options[..], &["--track", &near]].concat()));
        let start = ["replay", "robot", "--anchors", &anchors, "--log", &room.log, "--track", &far];
        let output = host_sim(&[&start[..], &options].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let ((_, near), (_, far)) = (rows_of::<3>(&near), rows_of::<3>(&far));
        assert_eq!(near.len(), far.len());
        for (([_, x, y], _), ([_, far_x, far_y], _)) in near.iter().zip(&far) {
            let off = (far_x - east - x).hypot(far_y - north - y);
            assert!(off < 1e-3, "{scalar}: {off}");
        }
    }
}

#[test]
fn without_a_height_it_is_found_and_said() {
    let room = Room::new([0.1; 4], |_, t, anchor, range| vec![line(t, anchor, range)]);
    let report = room.report(&[]);
    assert_eq!(report["warnings"], Value::Array(vec![]));
    let of = |name: &str| report["height"][name].as_f64().unwrap();
    assert!((of("metres") - 1.0).abs() < 2.5 * of("sigma_m"), "{report}");
    assert!(of("sigma_m") < 0.3 && of("position_sigma_m") < 0.1, "{report}");
    assert_eq!(report["height"]["biases_m"].as_array().unwrap().len(), 4);
    assert!(report["accuracy"]["rmse_m"].as_f64().unwrap() < 0.15, "{report}");
    assert!(text(&host_sim(&room.replay(&[])).stdout).contains("from the ranges"));
    // A known height is not searched for.
    assert_eq!(room.report(&["--height", "1"])["height"], Value::Null);
    assert_eq!(room.report(&["--dim", "3"])["height"], Value::Null);
    let room = Room::clean();
    let heights = room.desk.file("heights.csv", "t,z\n0,1.0\n40,1.0\n");
    assert_eq!(room.report(&["--height", &heights])["warnings"], Value::Array(vec![]));
    assert!(room.rmse(&["--height", &heights]) < 0.1);
    assert!(room.rmse(&["--dim", "3"]) < 0.6, "four anchors hardly see the height");
}

#[test]
fn a_height_that_ranges_do_not_tell_is_asked_for() {
    // A stationary tag beside three anchors, of which all or only two are heard.
    let desk = Desk::new();
    let places = [[2.8, 0.0, 1.3], [0.1, 0.0, 2.0], [1.9, 4.1, 2.1]];
    let anchors = desk.file("a.csv", "anchor,x,y,z\n0,2.8,0,1.3\n1,0.1,0,2\n2,1.9,4.1,2.1\n");
    for (heard, expected) in [(3, "only, and its position"), (2, "do not tell the tag's height")] {
        let mut log = "t,anchor,range\n".to_owned();
        for epoch in 0..50 {
            for (index, [x, y, z]) in places.iter().enumerate().take(heard) {
                let range = (x - 3.5_f64).hypot(y - 4.7).hypot(*z);
                let _ = writeln!(log, "{},{index},{range:.3}", 0.1 * f64::from(epoch));
            }
        }
        let log = desk.file("r.csv", log);
        let replay = ["replay", "robot", "--anchors", &anchors, "--log", &log];
        let sentence = refusal(&replay);
        assert!(sentence.contains(expected) && sentence.contains("--height"), "{sentence}");
        assert!(host_sim(&[&replay[..], &["--height", "0"]].concat()).status.success());
    }
}

#[test]
fn truth_never_reaches_the_estimator() {
    let room = Room::clean();
    let track = |truth: &str, name: &str, more: &[&str]| {
        let out = room.desk.named(name);
        let arguments = [&["--truth", truth, "--track", &out], more].concat();
        assert!(host_sim(&room.replay(&arguments)).status.success());
        fs::read_to_string(out).unwrap()
    };
    let wrong = room.desk.file("wrong.csv", "t,x,y,z\n0,99,-99,7\n40,99,-99,7\n");
    for more in [&["--height", "1"][..], &[]] {
        assert_eq!(track(&room.truth, "a.csv", more), track(&wrong, "b.csv", more));
    }
}

#[test]
fn planted_biases_are_found_and_their_file_helps() {
    let planted = [0.30, 0.10, 0.20, -0.05];
    let wild = |epoch: usize, t: f64, anchor: usize, range: f64| {
        vec![line(t, anchor, if epoch % 11 == 10 { [337.0, -143.0][epoch % 2] } else { range })]
    };
    let room = Room::new(planted, wild);
    let out = room.desk.named("calibration.csv");
    let found = json(&host_sim(&[
        "calibrate",
        "robot",
        "--anchors",
        &room.anchors,
        "--log",
        &room.log,
        "--truth",
        &room.truth,
        "--out",
        &out,
        "--json",
    ]));
    for (anchor, bias) in found["anchors"].as_array().unwrap().iter().zip(planted) {
        assert!((anchor["bias_m"].as_f64().unwrap() - bias).abs() < 0.02, "{anchor}");
    }
    assert!(fs::read_to_string(&out).unwrap().starts_with("anchor,bias,sigma,ranges\nA0,0."));
    let (with, without) =
        (room.rmse(&["--height", "1", "--calibration", &out]), room.rmse(&["--height", "1"]));
    assert!(with < 0.1 && with < 0.8 * without, "{with} {without}");
    let short = room.desk.file("short.csv", "anchor,bias\nA0,0.3\nA9,1\n");
    let warned = room.report(&["--height", "1", "--calibration", &short]);
    assert!(warned["warnings"][0].as_str().unwrap().contains("A1"));
    let centimetres =
        |epoch: usize, t: f64, anchor: usize, range: f64| wild(epoch, t, anchor, 100.0 * range);
    let room = Room::new(planted, centimetres);
    let (anchors, log, truth) = (&*room.anchors, &*room.log, &*room.truth);
    let sentence = refusal(&[
        "calibrate",
        "robot",
        "--anchors",
        anchors,
        "--log",
        log,
        "--truth",
        truth,
        "--out",
        &out,
    ]);
    assert!(sentence.contains("in another unit"), "{sentence}");
}

#[test]
fn bad_ranges_are_counted_and_do_no_harm() {
    let spoil = |epoch: usize, t: f64, anchor: usize, range: f64| {
        let good = line(t, anchor, range);
        let bad = |value: &str| format!("{t:.3},A{anchor},{value}");
        if anchor != epoch / 10 % 4 {
            return vec![good];
        }
        match epoch % 10 {
            0 => vec![bad("")],
            1 => vec![bad("nan")],
            2 => vec![bad("inf")],
            3 => vec![bad("-143")],
            4 => vec![bad("1000")],
            5 => vec![good.clone(), good],
            6 => vec![format!("{t:.3},stranger,3.0"), good],
            7 => vec![format!("{:.3},A{anchor},3.0", t - 5.0), good],
            _ => vec![good],
        }
    };
    let room = Room::new([0.0; 4], spoil);
    for scalar in ["f32", "f64", "fixed"] {
        let report = room.report(&["--height", "1", "--scalar", scalar]);
        assert!(report["accuracy"]["rmse_m"].as_f64().unwrap() < 0.12, "{report}");
        // Rejected are infinity, 1000 m, a repetition, and a range five seconds old; NaN and −143 m do not count as
        // ranges.
        assert_eq!(report["rejected"].as_u64(), Some(4 * 40), "{report}");
        for (warning, end) in [(0, "not listed: left out"), (1, "no distance: left out")] {
            let told = report["warnings"][warning].as_str().unwrap();
            assert!(told.starts_with("40 ranges") && told.ends_with(end), "{told}");
        }
    }
}

#[test]
fn a_time_far_off_ends_nothing() {
    for (spoilt, off) in [(100, 1e6), (300, -1e6)] {
        let spoil = |epoch: usize, t: f64, anchor: usize, range: f64| {
            let off = if (epoch, anchor) == (spoilt, 2) { off } else { 0.0 };
            vec![line(t + off, anchor, range)]
        };
        let report = Room::new([0.0; 4], spoil).report(&["--height", "1"]);
        assert!(report["accuracy"]["rmse_m"].as_f64().unwrap() < 0.1, "{report}");
        assert_eq!(report["accuracy"]["positions"], 400);
        assert!(report["warnings"][0].as_str().unwrap().starts_with("1 samples"));
    }
}

#[test]
fn an_outage_is_survived() {
    let silent = |epoch: usize, t: f64, anchor: usize, range: f64| {
        if (150..250).contains(&epoch) { vec![] } else { vec![line(t, anchor, range)] }
    };
    let room = Room::new([0.0; 4], silent);
    for (tracker, scalar) in [("default", "f32"), ("default", "fixed"), ("ekf", "fixed")] {
        let report = room.report(&["--height", "1", "--tracker", tracker, "--scalar", scalar]);
        assert!(report["accuracy"]["rmse_m"].as_f64().unwrap() < 0.25, "{tracker} {report}");
        assert!(report["accuracy"]["missed"].as_u64().unwrap() <= 1, "{report}");
    }
}

#[test]
fn points_are_found_in_their_order() {
    let desk = Desk::new();
    let room = Room::clean();
    let marks = [("b", [2.0, 2.0]), ("a", [6.0, 4.5]), ("c", [3.0, 5.0])];
    let mut rng = stream(6, 0);
    let mut log = "point,k,anchor,range\n".to_owned();
    for k in 0..50 {
        for (name, at) in marks {
            for (index, anchor) in ANCHORS.iter().enumerate() {
                let range = distance(*anchor, at) + normal(&mut rng, 0.03);
                let _ = writeln!(log, "{name},{k},A{index},{range:.4}");
            }
        }
    }
    let log = desk.file("ranges.csv", log);
    let known = desk.file("points.csv", "point,x,y,z\nb,2,2,1\na,6,4.5,1\nc,3,5,1\nnever,1,1,1\n");
    let names = desk.file("names.csv", "point,z\nb,1\na,1\nc,1\n");
    let replay = |points: &str| {
        json(&host_sim(&[
            "replay",
            "robot",
            "--anchors",
            &room.anchors,
            "--log",
            &log,
            "--points",
            points,
            "--height",
            points,
            "--json",
        ]))
    };
    let report = replay(&known);
    let found = report["points"].as_array().unwrap();
    assert_eq!(found.len(), 3);
    for (found, (name, at)) in found.iter().zip(marks) {
        assert_eq!(found["point"], name);
        let [x, y] = ["x", "y"].map(|axis| found[axis].as_f64().unwrap());
        assert!((x - at[0]).hypot(y - at[1]) < 0.05, "{found}");
        assert_eq!(found["z"], 1.0);
    }
    assert_eq!(report["accuracy"]["missed"], 1);
    assert!(report["warnings"][0].as_str().unwrap().ends_with("position: 1"));
    let blind = replay(&names);
    assert_eq!(blind["accuracy"], Value::Null);
    assert_eq!(blind["points"].as_array().unwrap()[..3], found[..3]);

    let out = desk.named("calibration.csv");
    let found = json(&host_sim(&[
        "calibrate",
        "robot",
        "--anchors",
        &room.anchors,
        "--log",
        &log,
        "--points",
        &known,
        "--out",
        &out,
        "--json",
    ]));
    assert!(found["anchors"][0]["bias_m"].as_f64().unwrap().abs() < 0.02);
}

#[test]
fn imu_and_wheels_may_have_any_columns() {
    let room = Room::clean();
    let imu = |name: &str, header: &str, row: &str| {
        let line = |k| format!("{:.3},{row}\n", 0.05 * f64::from(k));
        let rows = (0..800).map(line).collect::<Vec<_>>().concat();
        room.desk.file(name, format!("t,{header}\n{rows}"))
    };
    for (name, header, row) in [
        ("all.csv", "qw,qx,qy,qz,gx,gy,gz,ax,ay,az,lax,lay,laz", "1,0,0,0,0,0,0,1,2,9,1,-1,0.5"),
        ("force.csv", "ax,ay,az", "0.1,0.2,9.8"),
        ("linear.csv", "qw,qx,qy,qz,lax,lay,laz", "1,0,0,0,0.5,0,0"),
    ] {
        let rmse = room.rmse(&["--height", "1", "--imu", &imu(name, header, row)]);
        assert!(rmse < 0.4, "{name}: {rmse}");
    }
    let gyro = imu("gyro.csv", "gx,gy,gz", "0,0,0.1");
    let warned = room.report(&["--height", "1", "--imu", &gyro]);
    assert!(warned["warnings"][0].as_str().unwrap().contains("IMU"));
    let wheels = imu("odom.csv", "v_left,v_right,track", "0.3,0.4,0.2");
    assert!(room.rmse(&["--height", "1", "--odom", &wheels]) < 0.15);
}

#[test]
fn broken_files_are_refused_with_file_and_line() {
    let room = Room::clean();
    let desk = &room.desk;
    for (name, contents, expected) in [
        ("a.csv", "", "empty file"),
        ("b.csv", "t,anchor,range\n", "only a header"),
        ("c.csv", "t,anchor\n0,A0\n", "line 1: expected a header with a column range"),
        ("d.csv", "t,anchor,range\n0,A0,1\nx,A0,1\n", "line 3: expected a time in column t"),
        ("e.csv", "t,anchor,range\n0,A0,one\n", "line 2: expected a range or nothing"),
        ("f.csv", "t,anchor,range\n0,A0\n", "line 2: expected 3 fields"),
        ("g.csv", "t,anchor,range\n1e99,A0,1\n", "beyond any clock"),
        ("m.csv", "t,anchor,range\n0,B7,1\n", "expected ranges to anchors"),
        ("n.csv", "t,anchor,range\n0,1,1\n0,2,1\n0,3,1\n0,4,1\n", "anchors counted from 0"),
    ] {
        let log = desk.file(name, contents);
        let files = ["replay", "robot", "--strict", "--anchors", &room.anchors, "--log", &log];
        let sentence = refusal(&files);
        assert!(sentence.contains(name) && sentence.contains(expected), "{sentence}");
    }
    let too_many = (0..33).map(|index| format!("{index},{index},0,1\n"));
    let too_many = too_many.collect::<Vec<_>>().concat();
    for (name, contents, expected) in [
        ("h.csv", "anchor,x,y,z\n1,NaN,0,0\n".to_owned(), "line 2: expected a finite number"),
        ("i.csv", "anchor,x,y,z\n1,0,0,0\n1,1,0,0\n".to_owned(), "line 3: expected another anchor"),
        ("j.csv", format!("anchor,x,y,z\n{too_many}"), "line 34: expected at most 32 anchors"),
    ] {
        let anchors = desk.file(name, contents);
        let sentence = refusal(&["replay", "robot", "--anchors", &anchors, "--log", &room.log]);
        assert!(sentence.contains(name) && sentence.contains(expected), "{sentence}");
    }
    let backwards = desk.file("k.csv", "t,x,y\n1,0,0\n0,0,0\n");
    let twice = desk.file("l.csv", "anchor,bias\nA0,0.1\nA0,0.2\n");
    let missing = desk.named("missing.csv");
    for (more, expected) in [
        (["--truth", &backwards], "k.csv, line 3: expected a time not before"),
        (["--calibration", &twice], "l.csv, line 3: expected another anchor"),
        (["--imu", &missing], "missing.csv: cannot be read"),
    ] {
        let sentence = refusal(&room.replay(&more));
        assert!(sentence.contains(expected), "{sentence}");
    }
}

#[test]
fn wrong_usage_is_one_sentence() {
    let room = Room::clean();
    for more in [
        &["--room", "1,2,3"][..],
        &["--room", "a,b,c,d"],
        &["--height", "-1e9"],
        &["--height", "nan"],
        &["--dim", "4"],
        &["--tracker", "best"],
        &["--truth", &room.truth, "--points", &room.truth],
        &["--track", &room.log],
        &["--track", &room.truth, "--truth", &room.truth],
    ] {
        refusal(&room.replay(more));
    }
    refusal(&["calibrate", "robot", "--anchors", &room.anchors, "--log", &room.log, "--out", "x"]);
    refusal(&["replay", "robot"]);
}

#[test]
fn walls_are_respected() {
    // To three anchors along a wall a tag and its mirror image look alike.
    let desk = Desk::new();
    let anchors = desk.file("a.csv", "anchor,x,y,z\n0,0,0,2\n1,2,0.05,2\n2,4,0,2\n");
    let mut log = "t,anchor,range\n".to_owned();
    for epoch in 0..50 {
        for (index, x) in [0.0_f64, 2.0, 4.0].into_iter().enumerate() {
            let range = ((1.0 - x).powi(2) + 9.0 + 1.0).sqrt();
            let _ = writeln!(log, "{:.1},{index},{range:.4}", 0.1 * f64::from(epoch));
        }
    }
    let log = desk.file("r.csv", log);
    for (room, sign) in [("-1,0,5,6", 1.0), ("-1,-6,5,0", -1.0)] {
        let track = desk.named("t.csv");
        let output = host_sim(&[
            "replay",
            "robot",
            "--anchors",
            &anchors,
            "--log",
            &log,
            "--height",
            "1",
            "--room",
            room,
            "--track",
            &track,
        ]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let (_, rows) = rows_of::<4>(&track);
        let (last, _) = rows.last().unwrap();
        assert!((last[2] - 3.0 * sign).abs() < 0.3, "{room}: {last:?}");
    }
}

#[test]
fn an_experiment_repeats() {
    let run = || host_sim(&["run", "robot", "--trials", "3", "--seed", "1", "--json"]).stdout;
    let first = run();
    assert_eq!(first, run());
    let report: Value = serde_json::from_slice(&first).unwrap();
    assert_eq!(report["points"].as_array().unwrap().len(), 15);
    assert_eq!(report["mean"]["published"]["aekf_cm"], 2.52);
    let cell = |group: &str, column: &str| report["mean"][group][column].as_f64().unwrap();
    assert!(cell("from_the_truth", "aekf_cm") < 4.0);
    assert!(cell("honest_start", "aekf_cm") > 8.0);
}
