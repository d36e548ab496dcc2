mod users;

use kestirim_replay::drone::{EnvironmentKind, Quantity, Stop, wavelength_m};
use kestirim_telemetry::{Message, PathLoss};
use std::fmt::Write as _;
use std::fs;
use std::sync::Arc;

use serde_json::{Value, json};

use super::*;
use crate::system::{AnySystem, Opened, Source, Wanted};
use crate::table::Found;

const IDS: [&str; 8] =
    ["map", "error", "spread", "path-loss", "clouds", "region", "information", "effective"];

fn open(name: &str) -> Box<dyn Opened> {
    let settings = Settings::new(settings::table(None));
    Drone.open(Source::Synthetic(name.to_owned()), &settings).unwrap()
}

fn answer(opened: &dyn Opened, sent: &Value) -> Arc<Answer> {
    opened.answer(&Settings::sent(opened.settings(), sent.as_object().unwrap()).unwrap()).unwrap()
}

fn given_settings(given: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(settings::table(None));
    for (name, text) in given {
        settings.set(name, text).unwrap();
    }
    settings
}

fn points(answer: &Answer, figure: &str, series: &str) -> Vec<(f64, f64)> {
    let figure = answer.figures.iter().find(|found| found.id == figure).unwrap();
    let series = figure.series.iter().find(|found| found.name == series).unwrap();
    series.x.iter().copied().zip(series.y.iter().copied()).collect()
}

fn ids(answer: &Answer) -> Vec<&str> {
    answer.figures.iter().map(|figure| figure.id.as_str()).collect()
}

fn disabled(answer: &Answer) -> Vec<&str> {
    answer.disabled.iter().map(|(name, _)| *name).collect()
}

#[test]
fn synthetic_flights_answer_with_the_same_figures_whatever_the_settings() {
    let staying = [
        json!({}),
        json!({ "filter": "published", "resampler": "residual", "trajectory": "grid", "step": 1 }),
        json!({ "trajectory": "small-grid", "environment": "high-rise", "measurements": 40 }),
    ];
    let moving = [
        json!({ "end-time": 100 }),
        json!({ "end-time": 100, "flight": "hover", "user-radius": 0, "step": 1000 }),
        json!({ "end-time": 100, "flight": "low", "environment": "suburban", "noise": 2 }),
    ];
    for (name, all) in [("staying", staying), ("moving", moving)] {
        let opened = open(name);
        for sent in all {
            let answer = answer(&*opened, &sent);
            assert_eq!(ids(&answer), IDS, "{sent}");
            assert!(!points(&answer, "map", "particles").is_empty(), "{sent}");
            assert!(!disabled(&answer).contains(&"environment"), "{sent}");
        }
    }
    let settings = Settings::new(settings::table(None));
    assert!(Drone.open(Source::Synthetic("flying".to_owned()), &settings).is_err());
}

#[test]
fn every_setting_of_a_synthetic_user_changes_something_or_says_why_not() {
    let staying: (&str, Value, &[(&str, Value)]) = (
        "staying",
        json!({}),
        &[
            ("step", json!(3)),
            ("environment", json!("dense-urban")),
            ("filter", json!("published")),
            ("trajectory", json!("grid")),
            ("radius", json!(300)),
            ("measurements", json!(9)),
            ("particles", json!(250)),
            ("height", json!(400)),
            ("speed", json!(60)),
            ("seed", json!(1)),
        ],
    );
    let moving: (&str, Value, &[(&str, Value)]) = (
        "moving",
        json!({ "end-time": 40 }),
        &[
            ("step", json!(3)),
            ("environment", json!("dense-urban")),
            ("flight", json!("low")),
            ("particles", json!(250)),
            ("height", json!(400)),
            ("user-radius", json!(300)),
            ("end-time", json!(50)),
            ("noise", json!(2)),
            ("speed", json!(60)),
            ("seed", json!(1)),
        ],
    );
    for (name, base, changes) in [staying, moving] {
        let opened = open(name);
        let before = answer(&*opened, &base);
        let mut known = disabled(&before);
        for (setting, value) in changes {
            let mut sent = base.clone();
            sent[*setting] = value.clone();
            let after = answer(&*opened, &sent);
            let same = after.facts == before.facts && after.figures == before.figures;
            assert!(!same, "{name}: {setting}");
            assert!(after.command.contains(&format!("--{setting} ")), "{}", after.command);
            known.push(setting);
        }
        let mut all: Vec<_> = opened.settings().iter().map(|setting| setting.name).collect();
        known.sort_unstable();
        all.sort_unstable();
        assert_eq!(known, all, "{name}");
    }
}

#[test]
fn stepping_moves_the_cloud_and_nothing_that_is_over_all_steps() {
    let opened = open("moving");
    let at = |step: u32| answer(&*opened, &json!({ "end-time": 100, "step": step }));
    let (early, late) = (at(3), at(80));
    assert_ne!(points(&early, "map", "particles"), points(&late, "map", "particles"));
    assert_eq!(points(&early, "error", "error"), points(&late, "error", "error"));
    assert_eq!(points(&late, "map", "drone").len(), 80);
    let other = answer(&*opened, &json!({ "end-time": 100, "step": 80, "seed": 3 }));
    assert_ne!(points(&late, "error", "error"), points(&other, "error", "error"));
}

#[test]
fn the_cloud_gathers_where_the_user_is() {
    let opened = open("staying");
    for filter in ["best", "published"] {
        let sent = json!({ "filter": filter, "measurements": 40 });
        let answer = answer(&*opened, &sent);
        let spread = points(&answer, "spread", "spread, m");
        assert!(spread[39].1 < spread[0].1 / 2.0, "{filter}: {spread:?}");
        assert!(points(&answer, "error", "error")[39].1 < 400.0, "{filter}");
    }
}

#[test]
fn a_replay_of_a_synthetic_user_is_of_the_step_that_is_shown() {
    let opened = open("staying");
    let replay = |given: &[(&str, &str)]| {
        let settings = given_settings(given);
        opened.replay(&settings, &Wanted::default())
    };
    let (all, third) = (replay(&[]).unwrap().report, replay(&[("step", "3")]).unwrap().report);
    assert_eq!((&all["measurements"], &third["measurements"]), (&json!(12), &json!(3)));
    assert!(all["accuracy"]["error_m"].is_f64() && all["accuracy"] != third["accuracy"]);
    for (name, text, expected) in [
        ("environment", "open", "--environment open is for a recorded flight"),
        ("resampler", "residual", "--resampler is for --filter published"),
        ("noise", "1", "--noise is for a synthetic recording: --synthetic moving"),
    ] {
        let refusal = replay(&[(name, text)]).unwrap_err().to_string();
        assert!(refusal.contains(expected), "{refusal}");
    }
}

#[test]
fn a_log_is_searched_and_refused_as_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let (log, truth) = (folder.path().join("stops.csv"), folder.path().join("truth.csv"));
    let mut text = "t,x,y,h,rssi_db\n".to_owned();
    for k in 0..12 {
        let t = f64::from(k);
        // The geometry is wide enough to tell both sides apart, although the channel is not known.
        let (x, y) = (40.0 * t, 120.0 * (t * 0.9).sin());
        let far = (x - 200.0).hypot(y - 100.0).hypot(40.0);
        writeln!(text, "{t},{x:.3},{y:.3},40,{:.3}", -40.0 - 20.0 * far.log10()).unwrap();
    }
    fs::write(&log, text).unwrap();
    fs::write(&truth, "x,y\n200,100\n").unwrap();
    let mut files = Files::default();
    let settings = Settings::new(settings::table(None));
    let open = |files: &Files| Drone.open(Source::Files(files.clone()), &settings);
    assert!(open(&files).is_err());
    files.add("log", &log);
    files.add("truth", &truth);
    let opened = open(&files).unwrap();
    let first = answer(&*opened, &json!({ "step": 1 }));
    let last = answer(&*opened, &json!({}));
    assert_eq!(ids(&last), IDS);
    assert_ne!(points(&first, "map", "particles"), points(&last, "map", "particles"));
    assert!(points(&last, "error", "error")[11].1 < 60.0);
    let all = opened.settings().len();
    assert_eq!(disabled(&last).len() + 3, all, "step, environment and window are all that act");
    fs::write(&log, "t,x,y,h,rssi_db\n0,0,0,40,-60\n").unwrap();
    let refusal = open(&files).err().unwrap().to_string();
    assert!(refusal.contains("at least three measurements"), "{refusal}");
}

/// Path losses of a user at 150 m, 120 m in a suburban environment at 433 MHz.
fn at_433_mhz() -> Vec<Stop> {
    let channel = EnvironmentKind::Suburban.channel_at::<f64>(wavelength_m(433e6)).unwrap();
    let stop = |k: u32| {
        let (t, turn) = (f64::from(k), f64::from(k) * 0.3);
        let place = [200.0 + 150.0 * turn.cos(), 100.0 + 150.0 * turn.sin()];
        let far = (place[0] - 150.0).hypot(place[1] - 120.0);
        let loss = channel.path_loss(far, 200.0).unwrap().mean();
        Stop { t, place, height: 200.0, loss, heading: None }
    };
    (0..40).map(stop).collect()
}

/// With the right frequency the results are as at 2 GHz, even if all losses are 3 dB off; without it nothing fits.
#[test]
fn path_losses_are_those_of_a_frequency() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("stops.csv");
    let write = |off: f64| {
        let mut text = "t,x,y,h,path_loss_db\n".to_owned();
        for Stop { t, place: [x, y], height, loss, .. } in at_433_mhz() {
            writeln!(text, "{t},{x:.3},{y:.3},{height},{:.3}", loss + off).unwrap();
        }
        fs::write(&log, text).unwrap();
    };
    let mut files = Files::default();
    files.add("log", &log);
    let found = |given: &[(&'static str, &str)]| {
        let settings = given_settings(given);
        let opened = Drone.open(Source::Files(files.clone()), &settings).unwrap();
        let report = opened.replay(&settings, &Wanted::default()).unwrap().report;
        let [x, y] = ["x", "y"].map(|axis| report["estimate"][axis].as_f64().unwrap());
        ((x - 150.0).hypot(y - 120.0), report["health"]["state"].clone())
    };
    let mut near = 0.0;
    for off in [-3.0, 3.0, 0.0] {
        write(off);
        let (found, health) = found(&[("environment", "suburban"), ("frequency", "433")]);
        assert!(found < 10.0 && health == "good", "{off} dB: {found} m, {health}");
        near = found;
    }
    let (far, health) = found(&[("environment", "suburban")]);
    assert!(far > 3.0 * near && health == "bad", "{far} m, {health}");
}

#[test]
fn a_stream_that_contradicts_its_environment_is_told() {
    let heard = |given: &[(&str, &str)]| {
        let settings = given_settings(given);
        let plan = <Drone as System>::online(&settings, &Files::default()).unwrap().unwrap();
        let mut listener = plan.build().unwrap();
        for Stop { t, place: [x, y], height, loss, .. } in at_433_mhz() {
            let place = [x as f32, y as f32, height as f32];
            let time_us = (t * 1e6) as u64;
            listener.take(&Message::PathLoss(PathLoss { time_us, place, loss: loss as f32 }));
        }
        listener.finish().unwrap();
        let [x, y, _] = listener.position().unwrap();
        ((x - 150.0).hypot(y - 120.0), listener.warnings())
    };
    let (near, warnings) = heard(&[("environment", "suburban"), ("frequency", "433")]);
    assert!(near < 10.0 && warnings.is_empty(), "{near} m, {warnings:?}");
    let (_, warnings) = heard(&[("environment", "suburban")]);
    assert!(warnings[0].contains("off what suburban explains"), "{warnings:?}");
    assert!(heard(&[]).1.is_empty());
}

#[test]
fn settings_are_refused_only_where_no_recording_has_them() {
    let refused = |given: &[(&str, &str)]| {
        let settings = given_settings(given);
        Drone.refuse_idle(&settings).is_err()
    };
    assert!(!refused(&[("environment", "open"), ("height", "300"), ("noise", "1")]));
    assert!(refused(&[("trajectory", "grid"), ("radius", "300")]));
}

#[test]
fn firmware_says_which_filter_and_what_differs() {
    let flight = |quantity| {
        let flight = recording::flight::Flight::new(quantity);
        let recorded = recording::Recorded {
            log: "a.csv".into(),
            flight,
            area: None,
            truth: recording::truth::Truth::default(),
            found: Found::default(),
        };
        Recording::Flight(Box::new(recorded))
    };
    let level = flight(Quantity::Level);
    let loss = flight(Quantity::PathLoss);
    for (recording, given, expected) in [
        (Some(&level), &[][..], "OpenGround::new(None)"),
        (Some(&loss), &[], "LevelPrior { mean: -38.46"),
        (
            Some(&loss),
            &[("environment", "urban"), ("frequency", "1000")],
            "Channel::new(&Environment::urban(), 0.3)",
        ),
        (Some(&level), &[("environment", "high-rise")], "Locator::<f32, 2000, 400, 3>"),
        (Some(&Recording::Staying), &[("particles", "250")], "Locator::<f32, 250, 12, 2>"),
        (
            Some(&Recording::Staying),
            &[("filter", "published"), ("resampler", "residual")],
            "resampler: Resampler::Residual,",
        ),
        (Some(&Recording::Moving), &[("flight", "low")], "Height::Between(100.0, 1000.0)"),
        (Some(&Recording::Moving), &[("flight", "hover")], "jitter: 16.0,"),
        (Some(&Recording::Moving), &[], "Height::Fixed(500.0)"),
        (None, &[], "GroundSearch::<f32, 120, 8>"),
    ] {
        let mut settings = Settings::new(settings::table(recording));
        for (name, text) in given {
            settings.set(name, text).unwrap();
        }
        let firmware = settings::firmware(recording, &settings);
        println!("{{\n{firmware}\n}}");
        assert!(firmware.contains(expected), "{firmware}");
    }
}
