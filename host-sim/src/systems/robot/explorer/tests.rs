use serde_json::{Value, json};

use super::*;
use crate::system::ScalarKind;
use crate::figure::Figure;

fn answer(explorer: &dyn Explorer, sent: &Value) -> Answer {
    let sent = sent.as_object().cloned().unwrap_or_default();
    explorer.answer(&Settings::sent(&explorer.controls(), &sent).unwrap()).unwrap()
}

fn figure<'a>(answer: &'a Answer, id: &str) -> &'a Figure {
    answer.figures.iter().find(|figure| figure.id == id).unwrap()
}

fn rmse_cm(answer: &Answer) -> f64 {
    let (_, value) = answer.facts.iter().find(|(name, _)| name == "RMSE").unwrap();
    value.trim_end_matches(" cm").parse().unwrap()
}

#[test]
fn every_bundled_recording_opens_with_the_same_figures() {
    for (name, _) in SOURCE.bundled {
        let opened = (SOURCE.open_bundled)(name).unwrap();
        let answer = answer(&*opened, &json!({}));
        let ids: Vec<_> = answer.figures.iter().map(|figure| figure.id.as_str()).collect();
        assert_eq!(ids, ["plan", "ranges", "health", "position", "error"], "{name}");
        assert!(answer.warnings.is_empty(), "{name}: {:?}", answer.warnings);
        assert!(rmse_cm(&answer) < 40.0, "{name}: {} cm", rmse_cm(&answer));
    }
}

#[test]
fn every_control_changes_the_track() {
    let opened = (SOURCE.open_bundled)("crowded-round").unwrap();
    let plan = |sent: &Value| figure(&answer(&*opened, sent), "plan").clone();
    let initial = plan(&json!({}));
    for sent in [
        json!({ "tracker": "ekf" }),
        json!({ "tracker": "lsq" }),
        json!({ "height": 1.0 }),
        json!({ "range_sigma": 0.5 }),
        json!({ "acceleration": 1.0 }),
        json!({ "gate": 1.0 }),
        json!({ "weakened": false }),
        json!({ "long": 2.0 }),
        json!({ "short": 0.5 }),
        json!({ "learns": false }),
        json!({ "decay": 0.5 }),
        json!({ "scalar": "fixed" }),
        json!({ "calibrated": false }),
        json!({ "dim": "3" }),
    ] {
        assert_ne!(initial, plan(&sent), "{sent}");
    }
}

#[test]
fn a_gate_leaves_out_what_a_wide_one_takes() {
    let opened = (SOURCE.open_bundled)("crowded-round").unwrap();
    let left_out = |sent: Value| {
        let answer = answer(&*opened, &sent);
        let crosses = figure(&answer, "ranges").series.last().cloned().unwrap();
        crosses.y.iter().filter(|y| y.is_finite()).count()
    };
    assert_eq!(left_out(json!({ "gated": false })), 0);
    assert!(left_out(json!({ "gate": 2.0 })) > left_out(json!({})));
}

#[test]
fn the_initial_settings_are_those_of_the_command_line() {
    let recording = bundled("line").unwrap();
    let opened = Opened { recording: recording.clone(), height_is_known: true };
    let settings = Settings::initial(&opened.controls());
    let setup = Setup { biases: recording.biases.clone(), ..Setup::of_the_office(ScalarKind::F32) };
    assert_eq!(opened.setup(&settings), setup);
    let tuning = controls::tuning(&settings);
    let tuned = trace(&recording, &setup, |setup| follow::build_tuned(setup, Some(&tuning)));
    assert_eq!(tuned.unwrap(), trace(&recording, &setup, follow::build).unwrap());
}

#[test]
fn what_cannot_be_read_is_refused_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let mut files = Files::default();
    assert!((SOURCE.open)(&files).is_err());
    files.add("anchors", file("anchors.csv", "anchor,x,y,z\nA,0,0,0\nB,5,0,0\nC,0,5,0\n"));
    files.add("log", file("log.csv", "t,anchor,range\n0,A,x\n"));
    let refusal = (SOURCE.open)(&files).err().unwrap().to_string();
    assert!(refusal.contains("log.csv, line 2: expected a range"), "{refusal}");
    file("log.csv", "t,anchor,range\n0,A,2.2\n0,B,4.1\n0,C,4.3\n");
    let opened = (SOURCE.open)(&files).unwrap();
    let answer = answer(&*opened, &json!({}));
    assert!(figure(&answer, "error").series.iter().all(|s| s.y.iter().all(|y| y.is_nan())));
    files.add("points", file("points.csv", "point,x,y\nP,0,0\n"));
    files.add("imu", file("imu.csv", "t\n0\n"));
    assert!((SOURCE.open)(&files).is_err());
}
