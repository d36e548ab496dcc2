//! Tests with several users on one flight, and with a moving one.

use std::fmt::Write as _;
use std::fs;

use kestirim_telemetry::{Message, PathLoss};
use serde_json::Value;

use super::given_settings;
use crate::system::{AnySystem, Files, Source, System, Wanted};
use crate::systems::drone::Drone;

/// The level of a user at one position, received at another, 40 m higher.
fn level([x, y]: [f64; 2], [east, north]: [f64; 2]) -> f64 {
    -40.0 - 20.0 * (east - x).hypot(north - y).hypot(40.0).log10()
}

/// The position of the drone after a number of steps: along lines to and fro, 300 m long and 40 m apart.
fn drone(step: u32) -> [f64; 2] {
    let (line, along) = (step / 16 % 8, f64::from(step % 16) * 20.0);
    [if line.is_multiple_of(2) { along } else { 300.0 - along }, 40.0 * f64::from(line)]
}

/// The number of steps, of a second each, of a flight that passes three times.
const THRICE: u32 = 384;

/// The position, after a number of seconds, of a user who walks 1 m/s, 380 m during a flight of [`THRICE`] steps.
fn walking(t: f64) -> [f64; 2] {
    [10.0 + 0.7 * t, 20.0 + 0.7 * t]
}

/// The report of a log's replay, and the health of each row of the track that it writes.
fn replayed_rows(log: &str, truth: &str, given: &[(&'static str, &str)]) -> (Value, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let track = folder.path().join("track.csv");
    let wanted = Wanted { tables: vec![("track", track.clone())], mcap: None };
    let report = replayed_for(&wanted, log, truth, given);
    let rows = fs::read_to_string(track).unwrap();
    let states = rows.lines().skip(1).filter_map(|row| row.rsplit(',').next().map(str::to_owned));
    (report, states.collect())
}

/// The report of a log's replay.
fn replayed(log: &str, truth: &str, given: &[(&'static str, &str)]) -> Value {
    replayed_for(&Wanted::default(), log, truth, given)
}

fn replayed_for(wanted: &Wanted, log: &str, truth: &str, given: &[(&'static str, &str)]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let mut files = Files::default();
    for (field, text) in [("log", log), ("truth", truth)] {
        let path = folder.path().join(format!("{field}.csv"));
        fs::write(&path, text).unwrap();
        files.add(field, &path);
    }
    let settings = given_settings(given);
    let opened = Drone.open(Source::Files(files), &settings).unwrap();
    opened.replay(&settings, wanted).unwrap().report
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
        // Too little is heard of a third user.
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
    let (mut log, mut truth) = ("t,x,y,h,rssi_db\n".to_owned(), "t,x,y\n".to_owned());
    for step in 0..THRICE {
        let (t, place) = (f64::from(step), drone(step));
        writeln!(log, "{t},{},{},40,{:.2}", place[0], place[1], level(walking(t), place)).unwrap();
    }
    for t in [0, THRICE - 1].map(f64::from) {
        let [x, y] = walking(t);
        writeln!(truth, "{t},{x},{y}").unwrap();
    }
    let error = |report: &Value| report["accuracy"]["error_m"].as_f64().unwrap();
    let (all, rows) = replayed_rows(&log, &truth, &[]);
    assert!(all["warnings"].to_string().contains("needs --window"), "{all}");
    assert_eq!(all["health"]["state"], "bad", "{all}");
    assert!(!rows.is_empty() && rows.iter().all(|row| row == "bad"), "{rows:?}");
    let (some, rows) = replayed_rows(&log, &truth, &[("window", "60")]);
    assert!(rows.iter().all(|row| row == "good"), "{rows:?}");
    assert!(!some["warnings"].to_string().contains("--window"), "{some}");
    assert!(error(&some) < 0.5 * error(&all), "{} {}", error(&some), error(&all));
    assert!(error(&some) < 3.0 * some["sd_m"].as_f64().unwrap(), "{some}");
}

#[test]
fn a_stream_of_a_user_who_moves_is_followed_by_a_window() {
    let followed = |given: &[(&'static str, &str)]| {
        let settings = given_settings(given);
        let plan = <Drone as System>::online(&settings, &Files::default()).unwrap().unwrap();
        let mut listener = plan.build().unwrap();
        for step in 0..THRICE {
            let (t, place) = (f64::from(step), drone(step));
            // The loss of the first metre at 2 GHz is 38.5 dB.
            let loss = -level(walking(t), place) - 40.0 + 38.5;
            let [x, y] = place.map(|axis| axis as f32);
            let time_us = u64::from(step) * 1_000_000;
            let heard = PathLoss { time_us, place: [x, y, 40.0], loss: loss as f32 };
            listener.take(&Message::PathLoss(heard));
        }
        listener.finish().unwrap();
        assert!(listener.facts().iter().any(|(name, _)| name == "measure next at"));
        let [x, y, _] = listener.position().unwrap();
        let [east, north] = walking(f64::from(THRICE - 1));
        (x - east).hypot(y - north)
    };
    let (some, all) = (followed(&[("window", "60")]), followed(&[]));
    assert!(some < 0.5 * all, "{some} m, {all} m of all");
}

/// A directional antenna pointing forwards on a drone that flies to and fro: if the heading is known it causes no error
/// of the position.
#[test]
fn a_heading_is_read_and_explains_an_antenna_that_turns() {
    let user = [120.0, 190.0];
    let (mut with, mut without) = ("t,x,y,h,rssi_db,heading_deg\n".to_owned(), String::new());
    without.push_str("t,x,y,h,rssi_db\n");
    for step in 0..128 {
        let (place, next) = (drone(step), drone(step + 1));
        let [along, across] = [next[0] - place[0], next[1] - place[1]];
        let heading = along.atan2(across);
        let sight = [user[0] - place[0], user[1] - place[1]];
        let forward = sight[0] * heading.sin() + sight[1] * heading.cos();
        let gain = 6.0 * forward / sight[0].hypot(sight[1]).hypot(40.0);
        let level = level(user, place) + gain;
        let [x, y] = place;
        writeln!(without, "{step},{x},{y},40,{level:.2}").unwrap();
        writeln!(with, "{step},{x},{y},40,{level:.2},{:.1}", heading.to_degrees()).unwrap();
    }
    let truth = "x,y\n120,190\n";
    let [known, unknown] = [with, without].map(|log| replayed(&log, truth, &[]));
    let of = |report: &Value| {
        (report["accuracy"]["error_m"].as_f64().unwrap(), report["sd_m"].as_f64().unwrap())
    };
    println!("{:?} {:?}", of(&known), of(&unknown));
    assert!(known["import"].to_string().contains("heading = heading_deg in °"), "{known}");
    assert!(of(&known).0 < 5.0 && of(&known).1 < 0.7 * of(&unknown).1, "{known} {unknown}");
}
