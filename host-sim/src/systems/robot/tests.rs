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
        let expected = [
            "plan",
            "dilution",
            "ranges",
            "residuals",
            "nis",
            "rejections",
            "hdop",
            "position",
            "error",
        ];
        assert_eq!(ids, expected, "{name}");
        assert!(answer.warnings.is_empty(), "{name}: {:?}", answer.warnings);
        assert!(rmse_cm(&answer) < 40.0, "{name}: {} cm", rmse_cm(&answer));
    }
}

#[test]
fn every_setting_changes_the_plan() {
    let [crowded, line] = ["crowded-round", "line"].map(open);
    // Compared as text: gaps are NaN, which is not equal to itself.
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
    // The smoother refuses recordings with people in the way for long.
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

/// The number of points in all series of a figure that have the name of an anchor.
fn count(figure: &Figure, anchor: &str) -> usize {
    let series = figure.series.iter().filter(|series| series.name == anchor);
    series.flat_map(|series| &series.y).filter(|y| y.is_finite()).count()
}

#[test]
fn each_anchors_ranges_are_told_apart_by_every_tracker() {
    for tracker in ["lsq", "nls", "ekf", "aekf", "aekf-published", "default"] {
        let answer = answer(&*open("crowded-round"), &json!({ "tracker": tracker }));
        let is_weighed = ["ekf", "aekf", "default"].contains(&tracker);
        for anchor in ["A1", "A2", "A3", "A4"] {
            let ranges = count(figure(&answer, "ranges"), anchor);
            assert!(ranges > 100, "{tracker} {anchor}: {ranges}");
            // The first position is computed from ranges that are not weighed.
            let residuals = count(figure(&answer, "residuals"), anchor);
            assert!(residuals + 10 > ranges, "{tracker} {anchor}: {residuals} of {ranges}");
            assert_eq!(count(figure(&answer, "nis"), anchor) > 100, is_weighed, "{tracker}");
            let bound = count(figure(&answer, "residuals"), &format!("{anchor} +2σ"));
            assert_eq!(bound > 100, is_weighed, "{tracker}");
            let shares = figure(&answer, "rejections");
            assert!(count(shares, anchor) >= ranges, "{tracker} {anchor}");
        }
    }
}

#[test]
fn the_share_that_was_left_out_is_of_the_last_ten_seconds() {
    let answer = answer(&*open("crowded-round"), &json!({ "gate": 2.0 }));
    let figure = figure(&answer, "rejections");
    let most = figure.series.iter().flat_map(|it| &it.y).fold(0.0, |a: f64, b| a.max(*b));
    assert!((20.0..=100.0).contains(&most), "{most} %");
    // There is a person in front of each anchor in turn, and none at the end.
    for series in &figure.series {
        let least = series.y.iter().skip(100).fold(100.0, |a: f64, b| a.min(*b));
        assert!(least < 5.0, "{}: {least} %", series.name);
    }
}

#[test]
fn the_path_knows_its_uncertainty_and_lies_over_the_dilution() {
    for (tracker, known) in [("default", true), ("lsq", false)] {
        let answer = answer(&*open("line"), &json!({ "tracker": tracker }));
        for id in ["plan", "dilution"] {
            let series = figure(&answer, id).series.iter().find(|it| it.name == "track").unwrap();
            assert_eq!(series.spread.is_some(), known, "{tracker} {id}");
            assert_eq!(series.times.as_ref().unwrap().len(), series.x.len());
        }
        let dilution = figure(&answer, "dilution");
        assert!(dilution.series.iter().any(|it| it.name.starts_with("HDOP 1")), "{tracker}");
        // The four anchors are in the corners of a room.
        let hdop = figure(&answer, "hdop");
        let used = hdop.series.last().unwrap().y.iter().filter(|y| y.is_finite());
        assert!(used.clone().count() > 10, "{tracker}");
        assert!(used.clone().all(|y| (0.9..2.5).contains(y)), "{tracker}: {used:?}");
    }
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
    let errors = figure(&answer, "error").series.iter().filter(|it| !it.name.starts_with('σ'));
    assert!(errors.flat_map(|series| &series.y).all(|y| y.is_nan()));
    assert!(answer.disabled.iter().any(|(name, _)| *name == "calibrated"));
    files.add("points", file("points.csv", "point,x,y\nP,0,0\n"));
    files.add("imu", file("imu.csv", "t\n0\n"));
    assert!(open(&files).is_err());
}
