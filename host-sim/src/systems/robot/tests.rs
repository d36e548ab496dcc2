use std::sync::Arc;

use serde_json::{Value, json};

use super::*;
use crate::figure::Figure;
use crate::system::{AnySystem, Opened, Source};

fn open(name: &str) -> Box<dyn Opened> {
    let settings = Settings::new(settings::table(None));
    Robot.open(Source::Synthetic(name.to_owned()), &settings).unwrap()
}

fn answer(opened: &dyn Opened, sent: &Value) -> Arc<Answer> {
    let sent = sent.as_object().cloned().unwrap_or_default();
    opened.answer(&Settings::sent(opened.settings(), &sent).unwrap()).unwrap()
}

fn figure<'a>(answer: &'a Answer, id: &str) -> &'a Figure {
    answer.figures.iter().find(|figure| figure.id == id).unwrap()
}

fn rmse_cm(answer: &Answer) -> f64 {
    let (_, value) = answer.facts.iter().find(|(name, _)| name == "RMSE").unwrap();
    value.trim_end_matches(" cm").parse().unwrap()
}

#[test]
fn every_synthetic_recording_opens_with_the_same_figures() {
    for (name, _) in Robot::SYNTHETIC {
        let answer = answer(&*open(name), &json!({}));
        let ids: Vec<_> = answer.figures.iter().map(|figure| figure.id.as_str()).collect();
        assert_eq!(ids, ["plan", "ranges", "health", "position", "error"], "{name}");
        assert!(answer.warnings.is_empty(), "{name}: {:?}", answer.warnings);
        assert!(rmse_cm(&answer) < 40.0, "{name}: {} cm", rmse_cm(&answer));
    }
}

#[test]
fn every_setting_changes_the_plan() {
    let [crowded, line] = ["crowded-round", "line"].map(open);
    // As text: gaps are NaN, which equals nothing.
    let of =
        |opened: &dyn Opened, sent: &Value| format!("{:?}", figure(&answer(opened, sent), "plan"));
    let plan = |sent: &Value| of(&*crowded, sent);
    let initial = plan(&json!({}));
    let mut turned = Vec::new();
    for sent in [
        json!({ "tracker": "ekf" }),
        json!({ "height": 1.0 }),
        json!({ "room": "anchors" }),
        json!({ "range-sigma": 0.5 }),
        json!({ "acceleration": 1.0 }),
        json!({ "gating": false }),
        json!({ "gate": 1.0 }),
        json!({ "huber": false }),
        json!({ "huber-long": 2.0 }),
        json!({ "huber-short": 0.5 }),
        json!({ "learning": false }),
        json!({ "decay": 0.5 }),
        json!({ "scalar": "fixed" }),
        json!({ "calibrated": false }),
        json!({ "dim": "3" }),
    ] {
        assert_ne!(initial, plan(&sent), "{sent}");
        turned.extend(
            settings::table(None).iter().map(|it| it.name).filter(|it| sent.get(it).is_some()),
        );
    }
    // A smoother refuses people who are in the way for long.
    let smooth = json!({ "smooth": true });
    assert_ne!(of(&*line, &json!({})), of(&*line, &smooth));
    assert!(answer(&*crowded, &smooth).warnings[0].starts_with("not smoothed: "));
    turned.push("smooth");
    assert_eq!(turned.len(), settings::table(None).len());
}

#[test]
fn a_setting_that_is_idle_changes_nothing() {
    let opened = open("points");
    let drawn = |answer: &Answer| format!("{:?}", answer.figures);
    for tracker in ["lsq", "nls", "ekf", "aekf", "aekf-published", "default"] {
        let plain = answer(&*opened, &json!({ "tracker": tracker }));
        for sent in [
            json!({ "range-sigma": 0.5 }),
            json!({ "acceleration": 1.0 }),
            json!({ "gating": false }),
            json!({ "gate": 1.0 }),
            json!({ "huber": false }),
            json!({ "huber-long": 2.0 }),
            json!({ "huber-short": 0.5 }),
            json!({ "learning": false }),
            json!({ "decay": 0.5 }),
        ] {
            let mut all = sent.clone();
            all["tracker"] = json!(tracker);
            let name = sent.as_object().unwrap().keys().next().unwrap();
            let is_idle = plain.disabled.iter().any(|(idle, _)| idle == name);
            let same = drawn(&answer(&*opened, &all)) == drawn(&plain);
            assert_eq!(is_idle, same, "{tracker} {sent}");
        }
    }
}

#[test]
fn a_gate_leaves_out_what_a_wide_one_takes() {
    let opened = open("crowded-round");
    let left_out = |sent: Value| {
        let answer = answer(&*opened, &sent);
        let crosses = figure(&answer, "ranges").series.last().cloned().unwrap();
        crosses.y.iter().filter(|y| y.is_finite()).count()
    };
    assert_eq!(left_out(json!({ "gating": false })), 0);
    assert!(left_out(json!({ "gate": 2.0 })) > left_out(json!({})));
}

#[test]
fn what_cannot_be_read_is_refused_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let settings = Settings::new(settings::table(None));
    let open = |files: &Files| Robot.open(Source::Files(files.clone()), &settings);
    let mut files = Files::default();
    assert!(open(&files).is_err());
    files.add("anchors", file("anchors.csv", "anchor,x,y,z\nA,0,0,0\nB,5,0,0\nC,0,5,0\n"));
    files.add("log", file("log.csv", "t,anchor,range\n0,A,x\n"));
    let refusal = open(&files).err().unwrap().to_string();
    assert!(refusal.contains("log.csv, line 2: expected a range"), "{refusal}");
    file("log.csv", "t,anchor,range\n0,A,2.2\n0,B,4.1\n0,C,4.3\n");
    let answer = answer(&*open(&files).unwrap(), &json!({}));
    assert!(figure(&answer, "error").series.iter().all(|s| s.y.iter().all(|y| y.is_nan())));
    assert!(answer.disabled.iter().any(|(name, _)| *name == "calibrated"));
    files.add("points", file("points.csv", "point,x,y\nP,0,0\n"));
    files.add("imu", file("imu.csv", "t\n0\n"));
    assert!(open(&files).is_err());
}
