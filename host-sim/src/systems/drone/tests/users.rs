//! Several users on one flight, and one who moves.

use std::fmt::Write as _;
use std::fs;

use serde_json::Value;

use super::given_settings;
use crate::system::{AnySystem, Files, Source, Wanted};
use crate::systems::drone::Drone;

/// Level of a user at a place, heard at another, 40 m higher.
fn level([x, y]: [f64; 2], [east, north]: [f64; 2]) -> f64 {
    -40.0 - 20.0 * (east - x).hypot(north - y).hypot(40.0).log10()
}

/// Where the drone is after so many steps: along lines to and fro, 300 m long and 40 m apart.
fn drone(step: u32) -> [f64; 2] {
    let (line, along) = (step / 16 % 8, f64::from(step % 16) * 20.0);
    [if line.is_multiple_of(2) { along } else { 300.0 - along }, 40.0 * f64::from(line)]
}

/// What a replay of a log tells.
fn replayed(log: &str, truth: &str, given: &[(&'static str, &str)]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let mut files = Files::default();
    for (field, text) in [("log", log), ("truth", truth)] {
        let path = folder.path().join(format!("{field}.csv"));
        fs::write(&path, text).unwrap();
        files.add(field, &path);
    }
    let settings = given_settings(given);
    let opened = Drone.open(Source::Files(files), &settings).unwrap();
    opened.replay(&settings, &Wanted::default()).unwrap().report
}

#[test]
fn all_users_of_a_flight_are_found() {
    let users = [("a", [100.0, 60.0]), ("b", [250.0, 220.0])];
    let mut log = "t,x,y,h,rssi_db,user\n".to_owned();
    for step in 0..128 {
        let place = drone(step);
        for (name, user) in &users {
            let [x, y] = place;
            writeln!(log, "{step},{x},{y},40,{:.2},{name}", level(*user, place)).unwrap();
        }
        // Of a third one too little is heard.
        if step < 2 {
            writeln!(log, "{step},{},{},40,-99,c", place[0], place[1]).unwrap();
        }
    }
    let truth = "user,x,y\na,100,60\nb,250,220\n";
    let report = replayed(&log, truth, &[]);
    assert!(report["accuracy"]["error_m"].as_f64().unwrap() < 10.0, "{report}");
    let [b, c] = report["others"].as_array().unwrap().as_slice() else { panic!("{report}") };
    assert!(b["name"] == "b" && b["error_m"].as_f64().unwrap() < 10.0, "{report}");
    assert!(c["name"] == "c" && c["estimate"].is_null(), "{report}");
    let next = &report["next_waypoint"];
    let sd = next["sd_m"].as_f64().unwrap();
    assert!(sd <= report["sd_m"].as_f64().unwrap() && next["height_m"] == 40.0, "{report}");
    assert_eq!(report["warnings"].as_array().unwrap().len(), 1, "no area is given: {report}");
}

#[test]
fn a_user_who_moves_is_told_and_needs_a_window() {
    // They walk 1 m/s, 380 m in all, while the drone comes by three times.
    let user = |t: f64| [10.0 + 0.7 * t, 20.0 + 0.7 * t];
    let (mut log, mut truth) = ("t,x,y,h,rssi_db\n".to_owned(), "t,x,y\n".to_owned());
    for step in 0..384 {
        let (t, place) = (f64::from(step), drone(step));
        writeln!(log, "{t},{},{},40,{:.2}", place[0], place[1], level(user(t), place)).unwrap();
    }
    for t in [0.0, 383.0] {
        let [x, y] = user(t);
        writeln!(truth, "{t},{x},{y}").unwrap();
    }
    let error = |report: &Value| report["accuracy"]["error_m"].as_f64().unwrap();
    let all = replayed(&log, &truth, &[]);
    assert!(all["warnings"].to_string().contains("needs --window"), "{all}");
    let some = replayed(&log, &truth, &[("window", "60")]);
    assert!(!some["warnings"].to_string().contains("--window"), "{some}");
    assert!(error(&some) < 0.5 * error(&all), "{} {}", error(&some), error(&all));
    assert!(error(&some) < 3.0 * some["sd_m"].as_f64().unwrap(), "{some}");
}
