use std::sync::Arc;

use serde_json::{Value, json};

use super::*;
use crate::figure::Figure;
use crate::system::{AnySystem, Opened, Source};

fn open(name: &str) -> Box<dyn Opened> {
    let settings = Settings::new(settings::table(None));
    Gnss.open(Source::Synthetic(name.to_owned()), &settings).unwrap()
}

fn answered(opened: &dyn Opened, sent: &Value) -> Arc<Answer> {
    let sent = sent.as_object().cloned().unwrap_or_default();
    opened.answer(&Settings::sent(opened.settings(), &sent).unwrap()).unwrap()
}

fn figure<'a>(answer: &'a Answer, id: &str) -> &'a Figure {
    answer.figures.iter().find(|figure| figure.id == id).unwrap()
}

#[test]
fn synthetic_recordings_answer_with_the_same_figures() {
    for (name, _) in Gnss::SYNTHETIC {
        let opened = open(name);
        let answer = answered(&*opened, &json!({}));
        let ids: Vec<_> = answer.figures.iter().map(|figure| figure.id.as_str()).collect();
        let expected =
            ["error", "components", "residuals", "phases", "sigma", "satellites", "plan"];
        assert_eq!(ids, expected, "{name}");
        assert!(answer.facts.iter().any(|(name, _)| name == "final error"), "{:?}", answer.facts);
        // Of the faults a tenth of an epoch's observations may be.
        let is_of_faults = |warning: &String| *name == "faults" && warning.contains("rejected");
        assert!(answer.warnings.iter().all(is_of_faults), "{:?}", answer.warnings);
    }
    assert!(recording::synthetic("winter").is_err());
}

#[test]
fn every_control_changes_what_it_should() {
    let opened = open("faults");
    let initial = answered(&*opened, &json!({}));
    let moving = json!({ "mode": "kinematic" });
    let published = json!({ "filter": "ikf", "published": true });
    let cases = [
        (json!({}), json!({ "filter": "gkf" }), "error"),
        (json!({}), json!({ "filter": "all" }), "error"),
        (json!({ "filter": "ikf" }), published, "error"),
        (json!({}), moving.clone(), "components"),
        (moving, json!({ "mode": "kinematic", "process-noise": 1e-4 }), "components"),
        (json!({}), json!({ "k0": 1.0 }), "residuals"),
        (json!({}), json!({ "k1": 6.0 }), "residuals"),
        (json!({}), json!({ "mask": 25.0 }), "residuals"),
        (json!({}), json!({ "until": 7200.0 }), "sigma"),
        (json!({}), json!({ "without": ["solid-tide"] }), "plan"),
        (json!({}), json!({ "without": ["troposphere"] }), "plan"),
        (json!({}), json!({ "without": ["relativity"] }), "plan"),
        (json!({}), json!({ "without": ["shapiro"] }), "plan"),
        (json!({}), json!({ "without": ["sagnac"] }), "plan"),
        (json!({}), json!({ "without": ["wind-up"] }), "phases"),
    ];
    for (before, after, id) in &cases {
        let [before, changed] = [before, after].map(|sent| answered(&*opened, sent));
        let [before, changed] = [&before, &changed].map(|answer| &figure(answer, id).series);
        assert!(before != changed, "{after} {id}");
    }
    // Nothing that was sent before lingers.
    let again = answered(&*opened, &json!({}));
    assert_eq!(
        (&again.facts, figure(&again, "error")),
        (&initial.facts, figure(&initial, "error"))
    );
}

#[test]
fn outliers_show_as_rejected_with_the_default_and_stay_in_with_the_plain_filter() {
    let opened = open("faults");
    let far = |filter: &str| {
        let answer = answered(&*opened, &json!({ "filter": filter }));
        let series = &figure(&answer, "residuals").series;
        let rejected = series.last().unwrap();
        assert_eq!(rejected.name, "rejected");
        let used = series.iter().take(series.len() - 1).flat_map(|series| &series.y);
        (used.filter(|residual| residual.abs() > figures::FAR).count(), rejected.x.len())
    };
    let ((plain, none), (few, rejected)) = (far("gkf"), far("default"));
    assert!(none == 0 && rejected > 50, "{none} {rejected}");
    assert!(plain > 50 && few < plain / 5, "{plain} {few}");
}

#[test]
fn all_filters_are_shown_beside_each_other() {
    let opened = open("clean");
    let answer = answered(&*opened, &json!({ "filter": "all", "until": 3600.0 }));
    // A line for each filter, and one for the health of all.
    assert_eq!((figure(&answer, "error").series.len(), answer.facts.len()), (6, 7));
    assert!(answer.command.ends_with("--synthetic clean --filter all --until 3600"));
    let disabled: Vec<_> = answer.disabled.iter().map(|(name, _)| *name).collect();
    assert_eq!(disabled, ["systems", "ambiguities", "process-noise", "scalar"]);
    let plain = answered(&*opened, &json!({ "filter": "gkf" }));
    let disabled: Vec<_> = plain.disabled.iter().map(|(name, _)| *name).collect();
    assert_eq!(
        disabled,
        ["systems", "ambiguities", "process-noise", "published", "k0", "k1", "scalar"]
    );
}

#[test]
fn a_recording_needs_its_files() {
    let settings = Settings::new(settings::table(None));
    let opened = Gnss.open(Source::Files(Files::default()), &settings);
    let sentence = opened.err().unwrap().to_string();
    assert_eq!(sentence, "a file is needed: --obs");
}

#[test]
fn the_first_epoch_alone_can_be_looked_at() {
    let opened = open("clean");
    let answer = answered(&*opened, &json!({ "until": 0.0 }));
    assert_eq!(figure(&answer, "error").series[0].x.len(), 1);
}
