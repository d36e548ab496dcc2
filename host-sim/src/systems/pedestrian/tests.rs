use std::sync::Arc;

use kestirim_replay::pedestrian::{Options, Trace, trace, walk, without_updates};
use serde_json::{Value, json};

use super::*;
use crate::figure::Figure;
use crate::system::{AnySystem, Opened, Source};

fn open(name: &str) -> Box<dyn Opened> {
    let settings = Settings::new(settings::table(None));
    Pedestrian.open(Source::Synthetic(name.to_owned()), &settings).unwrap()
}

fn answer(opened: &dyn Opened, sent: &Value) -> Arc<Answer> {
    let sent = sent.as_object().cloned().unwrap_or_default();
    opened.answer(&Settings::sent(opened.settings(), &sent).unwrap()).unwrap()
}

fn figure<'a>(answer: &'a Answer, id: &str) -> &'a Figure {
    answer.figures.iter().find(|figure| figure.id == id).unwrap()
}

fn fact<'a>(answer: &'a Answer, name: &str) -> &'a str {
    &answer.facts.iter().find(|(found, _)| found == name).unwrap().1
}

#[test]
fn every_synthetic_walk_opens_with_the_same_figures_and_is_walked_well() {
    for (name, _) in Pedestrian::SYNTHETIC {
        let answer = answer(&*open(name), &json!({}));
        let ids: Vec<_> = answer.figures.iter().map(|figure| figure.id.as_str()).collect();
        let expected = ["path", "accelerometer", "gyroscope", "magnitude", "velocity", "position"];
        assert_eq!(ids, expected, "{name}");
        let rmse: f64 = fact(&answer, "RMSE").trim_end_matches(" m").parse().unwrap();
        assert!(rmse < 1.0, "{name}: {rmse} m");
        assert!(answer.warnings.is_empty(), "{name}: {:?}", answer.warnings);
    }
}

#[test]
fn the_threshold_moves_its_lines_and_the_path() {
    let opened = open("route-50");
    let at =
        |threshold| answer(&*opened, &json!({ "detector": "magnitude", "threshold": threshold }));
    let (low, high) = (at(0.1), at(0.4));
    for id in ["path", "magnitude", "velocity", "position"] {
        assert_ne!(figure(&low, id), figure(&high, id), "{id}");
    }
    for id in ["accelerometer", "gyroscope"] {
        assert_eq!(figure(&low, id), figure(&high, id), "{id}");
    }
    assert_ne!(fact(&low, "path length"), fact(&high, "path length"));
}

#[test]
fn what_cannot_be_walked_is_refused_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.txt");
    let mut files = Files::default();
    files.add("log", &path);
    let settings = Settings::new(settings::table(None));
    let refusal = |files: &Files| {
        let opened = Pedestrian.open(Source::Files(files.clone()), &settings);
        opened.and_then(|opened| opened.answer(&settings)).err().map(|error| error.to_string())
    };
    for (text, expected) in [
        ("", "empty"),
        ("t,ax,ay,az,gx,gy,gz\n0,0,up,9.8,0,0,0\n", "line 2: expected a finite number"),
        ("0 0 0 1 0 0 0\n", "expected a log of at least 2 samples, found 1"),
    ] {
        std::fs::write(&path, text).unwrap();
        let refusal = refusal(&files).unwrap();
        assert!(refusal.contains(expected) && !refusal.contains('\n'), "{refusal}");
    }
    assert!(refusal(&Files::default()).is_some());
    assert!(Pedestrian.open(Source::Synthetic("the moon".to_owned()), &settings).is_err());
}

#[test]
fn a_trace_is_the_walk_and_more() {
    let Recording { log, .. } = Recording::synthetic(Walked::Route, 100.0, 1, 0).unwrap();
    let options = Options::default();
    let trace = trace(&log.samples, &options).unwrap();
    assert_eq!(trace.walk, walk(&log.samples, &options).unwrap());
    assert_eq!(trace.moments.len(), log.samples.len());
    let standing = trace.moments.iter().filter(|moment| moment.stance).count();
    assert!((0.3..0.8).contains(&(standing as f64 / log.samples.len() as f64)));
}

#[test]
fn without_updates_the_foot_never_stands_again_and_the_velocity_drifts() {
    let Recording { log, .. } = Recording::synthetic(Walked::Route, 100.0, 1, 0).unwrap();
    let options = Options::default();
    let drifting = without_updates(&log.samples, &options).unwrap();
    let left = drifting.moments.iter().position(|moment| !moment.stance).unwrap();
    assert!(left > 150 && drifting.moments[left..].iter().all(|moment| !moment.stance));
    let last_speed = |trace: &Trace| {
        let [x, y, z] = trace.moments.last().unwrap().velocity;
        x.hypot(y).hypot(z)
    };
    assert!(last_speed(&drifting) > 0.2, "{}", last_speed(&drifting));
    assert!(last_speed(&trace(&log.samples, &options).unwrap()) < 0.05);
}
