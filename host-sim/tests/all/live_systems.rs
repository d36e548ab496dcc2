//! Tests that a live stream ends with the same result as a replay of the same log.

use std::fmt::Write;

use host_sim::random::stream;
use host_sim::systems::pedestrian::simulate::{scenario::Scenario, sensor};
use host_sim::systems::robot::simulate::scenario::{ANCHORS, Office, line};
use host_sim::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, fly};
use kestirim_replay::drone::EnvironmentKind;
use kestirim_replay::uav::{Noise, Plant};
use kestirim_telemetry::{Flight, Imu, Message, PathLoss, Range};
use serde_json::Value;

use crate::program::{Desk, host_sim, json, refusal, rows_of, text};
use crate::sender::frames;

/// The report on a recording of these messages.
fn live(desk: &Desk, messages: Vec<Message>, arguments: &[&str]) -> Value {
    let recording = desk.file("live.frames", frames(messages));
    json(&host_sim(&[&["live", "--headless", "--json", "--file", &recording], arguments].concat()))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

#[test]
fn a_walk_is_as_long_as_in_a_causal_replay() {
    let desk = Desk::new();
    let mut rng = stream(3, 0);
    let ideal = Scenario::draw(&mut rng).ideal_imu(100.0);
    let mut log = "t,ax,ay,az,gx,gy,gz\n".to_owned();
    let mut messages = Vec::new();
    for sample in sensor::measure(&mut rng, &ideal, 100.0) {
        let axes = [sample.specific_force, sample.angular_rate].map(|axes| axes.map(|v| v as f32));
        let [[ax, ay, az], [gx, gy, gz]] = axes.map(|axes| axes.map(f64::from));
        let t = sample.time_us as f64 / 1e6;
        writeln!(log, "{t:.6},{ax},{ay},{az},{gx},{gy},{gz}").unwrap();
        let [specific_force, angular_rate] = axes;
        messages.push(Imu { time_us: sample.time_us, specific_force, angular_rate }.into());
    }
    let samples = messages.len();
    let log = desk.file("walk.csv", log);
    let replayed = json(&host_sim(&["replay", "pedestrian", "--causal", "--json", "--log", &log]));
    let followed = live(&desk, messages, &["--system", "pedestrian"]);
    assert_eq!(followed["counts"]["taken"], samples);
    assert_eq!(number(&followed["path_length_m"]), number(&replayed["path_length_m"]));
    assert!((number(&followed["path_length_m"]) - 12.6).abs() < 1.0);
}

#[test]
fn a_robot_ends_where_its_replay_ends() {
    let desk = Desk::new();
    let mut rng = stream(3, 1);
    let mut log = "t,anchor,range\n".to_owned();
    let mut messages = Vec::new();
    for row in Office::draw(&mut rng).measure(&mut rng, &line()) {
        let Some(range) = row.range else { continue };
        let (range, anchor, time_us) = (range as f32, row.anchor as u16, row.time_us as u64);
        let t = row.time_us as f64 / 1e6;
        writeln!(log, "{t:.6},A{},{}", anchor + 1, f64::from(range)).unwrap();
        messages.push(Range { time_us, anchor, range }.into());
    }
    let mut anchors = "anchor,x,y,z\n".to_owned();
    for (number, [x, y, z]) in ANCHORS.iter().enumerate() {
        writeln!(anchors, "A{},{x},{y},{z}", number + 1).unwrap();
    }
    let (log, anchors) = (desk.file("ranges.csv", log), desk.file("anchors.csv", anchors));
    let track = desk.named("track.csv");
    let arguments = ["replay", "robot", "--json", "--anchors", &anchors, "--height", "0"];
    let arguments = [&arguments[..], &["--log", &log, "--track", &track]].concat();
    let replayed = json(&host_sim(&arguments));
    let followed =
        live(&desk, messages, &["--system", "robot", "--anchors", &anchors, "--height", "0"]);
    assert_eq!(followed["counts"]["taken"], replayed["updates"]);
    assert_eq!(followed["counts"]["refused"], replayed["rejected"]);
    assert_eq!(followed["warnings"], Value::Array(vec![]));
    let (_, rows) = rows_of::<4>(track);
    let (last, _) = rows.last().unwrap();
    for axis in 0..3 {
        assert!((number(&followed["position"][axis]) - last[axis + 1]).abs() < 1e-5);
    }
}

#[test]
fn a_user_is_found_where_a_replay_finds_them() {
    let desk = Desk::new();
    let channel = EnvironmentKind::Suburban.channel::<f64>();
    let mut rng = stream(3, 2);
    let mut log = "t,x,y,h,path_loss_db\n".to_owned();
    let mut messages = Vec::new();
    for step in 0..60_u64 {
        let (sin, cos) = (step as f64 / 10.0).sin_cos();
        let place = [300.0 * cos, 300.0 * sin, 120.0].map(|metres| metres as f32);
        let [x, y, h] = place.map(f64::from);
        let user = [80.0, -120.0];
        let loss = host_sim::systems::drone::simulate::scenario::measure(
            &channel,
            user,
            [x, y],
            h,
            &mut rng,
        );
        let loss = loss as f32;
        writeln!(log, "{step},{x},{y},{h},{}", f64::from(loss)).unwrap();
        messages.push(PathLoss { time_us: step * 1_000_000, place, loss }.into());
    }
    let log = desk.file("flight.csv", log);
    let area = desk.file("area.csv", "x,y\n-400,-400\n400,-400\n400,400\n-400,400\n");
    let replayed = json(&host_sim(&["replay", "drone", "--json", "--log", &log, "--area", &area]));
    let followed = live(&desk, messages, &["--system", "drone", "--area", &area]);
    assert_eq!(followed["position"][0], replayed["estimate"]["x"]);
    assert_eq!(followed["position"][1], replayed["estimate"]["y"]);
}

#[test]
fn an_aeroplane_flies_as_in_its_replay() {
    let desk = Desk::new();
    let start = [0.0, 0.0, 2.0, 0.05].into();
    let rng = stream(3, 3);
    let flight = fly(Plant::P3.discrete(INTERVAL_S), start, Inputs::Sine, Noise::SENSORS, rng);
    let mut log = "t,delta_e,delta_t,q,V,theta\n".to_owned();
    let mut messages = Vec::new();
    for (number, sample) in flight.take(500).enumerate() {
        let time_us = number as u64 * 10_000;
        let inputs = [0, 1].map(|input| sample.u[input] as f32);
        let outputs = [1, 2, 3].map(|state| sample.y[state] as f32);
        let ([e, t], [q, v, theta]) = (inputs.map(f64::from), outputs.map(f64::from));
        writeln!(log, "{:.6},{e},{t},{q},{v},{theta}", time_us as f64 / 1e6).unwrap();
        messages.push(Flight { time_us, inputs, outputs }.into());
    }
    let log = desk.file("flight.csv", log);
    let replayed = json(&host_sim(&["replay", "uav", "--json", "--log", &log, "--model", "P3"]));
    let followed = live(&desk, messages, &["--system", "uav", "--model", "P3"]);
    for place in 0..4 {
        let (live, replay) = (&followed["state"][place], &replayed["estimate"][place]);
        assert!((number(live) - number(replay)).abs() < 1e-12, "state {place}: {live} {replay}");
    }
}

#[test]
fn what_an_estimator_cannot_work_with_is_one_sentence() {
    let desk = Desk::new();
    let new = desk.named("new.frames");
    let empty = desk.file("empty.csv", "");
    let flat = desk.file("flat.csv", "anchor,x,y\nA1,0,0\n");
    let outputs = desk.file(
        "outputs.json",
        r#"{"A":[[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,0]],"B":[[0,0],[0,0],[0,0],[0,0]],
            "C":[[1,0,0,0]],"outputs":["alpha"]}"#,
    );
    let wrong: [(&[&str], &str); 8] = [
        (&["--system", "robot", "--anchors", &empty], "empty"),
        (&["--system", "robot", "--anchors", &flat], "column z"),
        (&["--anchors", &flat], "--system robot"),
        (&["--system", "robot", "--model", "P1"], "--system uav"),
        (&["--system", "drone", "--area", &empty], "empty"),
        (&["--system", "uav"], "--model"),
        (&["--system", "uav", "--model", &outputs], "theta"),
        (&["--system", "uav", "--model", "P3", "--absolute"], "trim"),
    ];
    for (arguments, said) in wrong {
        let sentence = refusal(&[&["live", "--record", &new], arguments].concat());
        assert!(sentence.contains(said), "{arguments:?}: {sentence}");
        assert!(!desk.path("new.frames").exists(), "{arguments:?}: nothing was to be recorded");
    }
    let help = host_sim(&["live", "--help"]);
    assert!(text(&help.stdout).contains("--anchors"));
}
