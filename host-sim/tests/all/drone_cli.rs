//! Tests of the drone's commands: exit status, standard output, standard error, files.

use std::fs;
use std::process::Command;

use serde_json::json as value;

use crate::program::{Desk, host_sim, json, messages, refusal, text};

/// Path losses over open ground around a user at (120, −40), with an unknown level.
fn flight() -> String {
    let row = |k: u32| {
        let angle = f64::from(k) * 0.7;
        // Not a circle: from there a position and its inversion look alike.
        let radius = 50.0 + 7.0 * f64::from(k);
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        let level = -20.0 - 20.0 * (x - 120.0).hypot(y + 40.0).hypot(40.0).log10();
        format!("{}.5,{x:.2},{y:.2},40,{level:.3}\n", 10 * k)
    };
    "t,x,y,h,rssi_db\n".to_owned() + &(0..30).map(row).collect::<String>()
}

#[test]
fn a_cell_is_one_row() {
    let cell = |more: &[&str]| {
        let all = [&["run", "drone", "--json", "--trials", "20"], more].concat();
        let report = json(&host_sim(&all));
        assert_eq!(report["system"], "drone");
        let rows = report["rows"].as_array().expect("rows").clone();
        assert_eq!(rows.len(), 1, "{more:?}");
        rows[0].clone()
    };
    for more in [
        &["--filter", "paper", "--resampler", "residual"][..],
        &["--filter", "best", "--particles", "250", "--measurements", "5"],
        &["--height", "1000", "--radius", "500", "--environment", "high-rise"],
        &["--moving", "--end-time", "40", "--user-radius", "300", "--speed", "50"],
        &["--moving", "--filter", "paper", "--end-time", "40", "--height", "800"],
        &["--scalar", "fixed", "--particles", "100"],
    ] {
        let row = cell(more);
        for number in ["mean_m", "se_m", "rmse_m", "max_m", "energy_j"] {
            assert!(row[number].as_f64().is_some_and(|value| value > 0.0), "{more:?} {number}");
        }
        let moving = more.contains(&"--moving");
        assert_eq!(row["limit_m"].is_number(), !moving);
        assert_eq!(row["lost_percent"].is_number(), moving);
    }
    // By the printed formulas and constants: 337.6 kJ for the circle of four.
    let row = cell(&["--measurements", "4"]);
    assert!((row["energy_j"].as_f64().expect("energy") - 337_600.0).abs() < 100.0);
}

#[test]
fn the_answer_depends_on_the_seed_and_not_on_the_threads() {
    let run = |threads: &str, seed: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
        let arguments = ["run", "drone", "--filter", "paper", "--trials", "30", "--json", "--seed"];
        command.args(arguments).arg(seed).env("RAYON_NUM_THREADS", threads);
        command.output().expect("the program runs").stdout
    };
    assert_eq!(run("1", "7"), run("3", "7"));
    assert_ne!(run("1", "7"), run("1", "8"));
}

#[test]
fn a_flight_is_replayed() {
    let desk = Desk::new();
    let log = desk.file("flight.csv", flight());
    let truth = desk.file("truth.csv", "x,y\n120,-40\n");
    let area = desk.file("area.csv", "x,y\n-300,-300\n300,-300\n300,300\n-300,300\n");
    let track = desk.named("track.csv");
    let arguments =
        ["replay", "drone", "--log", &log, "--truth", &truth, "--area", &area, "--track", &track];
    let report = json(&host_sim(&[&arguments[..], &["--json"]].concat()));
    assert_eq!((&report["system"], &report["measurements"]), (&"drone".into(), &30.into()));
    assert!(report["accuracy"]["error_m"].as_f64().is_some_and(|error| error < 15.0));
    assert_eq!(report["accuracy"]["error_after_s"].as_array().map(Vec::len), Some(5));
    assert_eq!(report["accuracy"]["in_90_percent_region"], true);
    // The level at one metre, 100 m from the nearest measurement: an exponent that is off by 0.6 makes 12 dB.
    assert!(report["level_db"].as_f64().is_some_and(|level| (level + 20.0).abs() < 15.0));
    assert!(report["sd_m"].as_f64().is_some_and(|sd| sd > 1.0));
    let written = fs::read_to_string(&track).expect("a track");
    assert_eq!(written.lines().count(), 31);
    assert!(written.starts_with("t,x,y,sd,health\n0.500,"));
    let table = host_sim(&arguments);
    assert!(text(&table.stdout).contains("in the 90 % region"));
    let without = json(&host_sim(&["replay", "drone", "--log", &log, "--json"]));
    assert!(without["accuracy"].is_null());
    assert_eq!(without["warnings"].as_array().map(Vec::len), Some(1));
}

#[test]
fn a_replay_is_written_for_viewers() {
    let desk = Desk::new();
    let log = desk.file("flight.csv", flight());
    let truth = desk.file("truth.csv", "x,y\n120,-40\n");
    let file = desk.named("flight.mcap");
    let arguments = ["replay", "drone", "--log", &log, "--mcap", &file, "--json"];
    json(&host_sim(&arguments));
    let alone = messages(&file);
    assert_eq!((alone["/drone/measurements"], alone["/drone/estimate"]), (30, 30));
    assert!(!alone.contains_key("/drone/truth"));
    json(&host_sim(&[&arguments[..], &["--truth", &truth]].concat()));
    assert_eq!(messages(&file)["/drone/truth"], 30);
    assert!(refusal(&["replay", "drone", "--log", &log, "--mcap", &log]).contains("overwrite"));
}

#[test]
fn path_losses_through_a_city_need_no_level() {
    let desk = Desk::new();
    // The urban channel's expected loss with a line of sight, from 800 m above a circle to a user at (900, 1100).
    let row = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::FRAC_PI_6;
        let (x, y) = (1000.0 + 667.0 * angle.cos(), 1000.0 + 667.0 * angle.sin());
        let slant = (x - 900.0).hypot(y - 1100.0).hypot(800.0);
        let loss = 20.0 * (4.0 * std::f64::consts::PI * slant / 0.15).log10() + 1.0;
        format!("{k},{x},{y},800,{loss}\n")
    };
    let rows: String = (0..12).map(row).collect();
    let log = desk.file("city.csv", "t,x,y,h,path_loss_db\n".to_owned() + &rows);
    let truth = desk.file("truth.csv", "x,y\n900,1100\n");
    let area = desk.file("area.csv", "x,y\n0,0\n2000,0\n2000,2000\n0,2000\n");
    let replay = |log: &str| {
        let files = ["replay", "drone", "--log", log, "--truth", &truth, "--area", &area];
        json(&host_sim(&[&files[..], &["--environment", "urban", "--json"]].concat()))
    };
    let report = replay(&log);
    assert!(report["accuracy"]["error_m"].as_f64().is_some_and(|error| error < 60.0));
    assert!(report["level_db"].is_null());
    assert_eq!((&report["warnings"], &report["health"]["state"]), (&value!([]), &value!("good")));
    // As levels of an unknown transmitter.
    let levels = rows.lines().map(|line| {
        let (rest, loss) = line.rsplit_once(',').expect("fields");
        format!("{rest},{}\n", 17.0 - loss.parse::<f64>().expect("a loss"))
    });
    let levels = "t,x,y,h,rssi_db\n".to_owned() + &levels.collect::<String>();
    let log = desk.file("levels.csv", levels);
    let report = replay(&log);
    assert!(report["accuracy"]["error_m"].as_f64().is_some_and(|error| error < 150.0));
    assert!(report["level_db"].as_f64().is_some_and(|level| (level - 17.0).abs() < 4.0));
}

#[test]
fn wrong_input_is_refused_with_a_sentence() {
    let desk = Desk::new();
    let log = desk.file("flight.csv", flight());
    let replay = |log: &str| refusal(&["replay", "drone", "--log", log]);
    let named = |contents: &str| replay(&desk.file("wrong.csv", contents));
    assert!(named("t,x,y,h\n").contains("rssi_db"));
    assert!(named("t,x,y,h,rssi_db\n1,2,3,4,x\n").contains("line 2"));
    assert!(named("t,x,y,h,rssi_db\n1,2,3,4,-50\n").contains("three"));
    assert!(named("").contains("empty"));
    assert!(replay(&desk.named("absent.csv")).contains("absent.csv"));
    let with = |option: &str, contents: &str| {
        let file = desk.file("other.csv", contents);
        refusal(&["replay", "drone", "--log", &log, option, &file])
    };
    assert!(with("--truth", "x,y\n1,2\n3,4\n").contains("line 3"));
    assert!(with("--area", "x,y\n1,2\n3,4\n").contains("square metre"));
    let corner = |k: u32| format!("{k},{}\n", k * k);
    let many = "x,y\n".to_owned() + &(0..5000).map(corner).collect::<String>();
    assert!(with("--area", &many).contains("4096 corners"));
    assert!(refusal(&["replay", "drone", "--log", &log, "--track", &log]).contains("overwrite"));
    let both = ["replay", "drone", "--log", &log, "--free-space", "--environment", "urban"];
    assert!(refusal(&both).contains("--environment"));
    for wrong in [
        &["--particles", "0"][..],
        &["--particles", "5000"],
        &["--height", "-3"],
        &["--measurements", "0"],
        &["--user-radius", "100"],
        &["--moving", "--radius", "100"],
        &["--filter", "worst"],
        &["--trials", "0"],
    ] {
        refusal(&[&["run", "drone"], wrong].concat());
    }
}
