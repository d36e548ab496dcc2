use serde_json::{Value, json};

use super::*;

fn answer(explorer: &dyn Explorer, sent: &Value) -> Answer {
    let sent = sent.as_object().cloned().unwrap_or_default();
    explorer.answer(&Settings::sent(&explorer.controls(), &sent).unwrap()).unwrap()
}

fn figure<'a>(answer: &'a Answer, id: &str) -> &'a Figure {
    answer.figures.iter().find(|figure| figure.id == id).unwrap()
}

fn fact<'a>(answer: &'a Answer, name: &str) -> &'a str {
    &answer.facts.iter().find(|(found, _)| found == name).unwrap().1
}

#[test]
fn every_bundled_walk_opens_with_the_same_figures_and_is_walked_well() {
    for (name, _) in SOURCE.bundled {
        let opened = (SOURCE.open_bundled)(name).unwrap();
        let answer = answer(&*opened, &json!({}));
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
    let opened = (SOURCE.open_bundled)("route-50").unwrap();
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
fn every_other_control_changes_the_path() {
    let opened = (SOURCE.open_bundled)("route-100").unwrap();
    let path = |sent: Value| figure(&answer(&*opened, &sent), "path").clone();
    let initial = path(json!({}));
    for sent in [
        json!({ "tracker": "lite" }),
        json!({ "detector": "shoe" }),
        json!({ "sensor": "industrial" }),
        json!({ "contact_height": 0.0 }),
        json!({ "causal": true }),
        json!({ "scalar": "fixed" }),
    ] {
        assert_ne!(initial, path(sent.clone()), "{sent}");
    }
    let fixed = |factor: f64| path(json!({ "detector": "variance", "factor": factor }));
    assert_ne!(fixed(1.0), fixed(5.0));
}

#[test]
fn the_initial_settings_are_those_of_the_command_line() {
    let opened = (SOURCE.open_bundled)("route-100").unwrap();
    let initial = controls::options(&Settings::initial(&opened.controls()));
    let default = Options { contact_height_m: Some(0.07), ..Options::default() };
    assert_eq!(initial, default);
}

#[test]
fn what_cannot_be_walked_is_refused_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.txt");
    let mut files = Files::default();
    files.add("log", &path);
    for (text, expected) in [
        ("", "found an empty file"),
        ("0 0 0 1 0 0 0\n10 0 0 1 0 0\n", "line 2: expected 7 blank-separated fields"),
        ("0 0 0 1 0 0 0\n", "expected a log of at least 2 samples, found 1"),
    ] {
        std::fs::write(&path, text).unwrap();
        let refusal = (SOURCE.open)(&files).err().unwrap().to_string();
        assert!(refusal.contains(expected) && !refusal.contains('\n'), "{refusal}");
    }
    assert!((SOURCE.open)(&Files::default()).is_err());
    assert!((SOURCE.open_bundled)("the moon").is_err());
}
