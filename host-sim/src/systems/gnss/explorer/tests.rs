use serde_json::json;

use super::*;
use crate::explore::Settings;

fn answered(explorer: &dyn Explorer, sent: &serde_json::Value) -> Answer {
    let settings = Settings::sent(&explorer.controls(), sent.as_object().unwrap()).unwrap();
    explorer.answer(&settings).unwrap()
}

fn figure<'a>(answer: &'a Answer, id: &str) -> &'a Figure {
    answer.figures.iter().find(|figure| figure.id == id).unwrap()
}

#[test]
fn bundled_recordings_answer_with_the_same_figures() {
    for (name, _) in SOURCE.bundled {
        let explorer = (SOURCE.open_bundled)(name).unwrap();
        let answer = answered(&*explorer, &json!({}));
        let ids: Vec<_> = answer.figures.iter().map(|figure| figure.id.as_str()).collect();
        let expected =
            ["error", "components", "residuals", "phases", "sigma", "satellites", "plan"];
        assert_eq!(ids, expected, "{name}");
        assert!(answer.facts.iter().any(|(name, _)| name == "final error"), "{:?}", answer.facts);
        assert!(answer.warnings.is_empty(), "{:?}", answer.warnings);
    }
    assert!((SOURCE.open_bundled)("winter").is_err());
}

#[test]
fn every_control_changes_what_it_should() {
    let explorer = (SOURCE.open_bundled)("faults").unwrap();
    let initial = answered(&*explorer, &json!({}));
    let moving = json!({ "mode": "kinematic" });
    let by_letter = json!({ "filter": "ikf", "printed": true });
    let cases = [
        (json!({}), json!({ "filter": "gkf" }), "error"),
        (json!({}), json!({ "compare": true }), "error"),
        (json!({ "filter": "ikf" }), by_letter, "error"),
        (json!({}), moving.clone(), "components"),
        (moving, json!({ "mode": "kinematic", "process-noise": 1e-4 }), "components"),
        (json!({}), json!({ "thresholds": true, "k0": 1.0, "k1": 6.0 }), "residuals"),
        (json!({}), json!({ "mask": 25.0 }), "residuals"),
        (json!({}), json!({ "until": 2.0 }), "sigma"),
        (json!({}), json!({ "solid-tide": false }), "plan"),
        (json!({}), json!({ "troposphere": false }), "plan"),
        (json!({}), json!({ "relativity": false }), "plan"),
        (json!({}), json!({ "shapiro": false }), "plan"),
        (json!({}), json!({ "sagnac": false }), "plan"),
        (json!({}), json!({ "wind-up": false }), "phases"),
    ];
    for (before, after, id) in &cases {
        let [before, changed] = [before, after].map(|sent| answered(&*explorer, sent));
        let [before, changed] = [&before, &changed].map(|answer| &figure(answer, id).series);
        assert!(before != changed, "{after} {id}");
    }
    // Nothing that was sent before lingers.
    let again = answered(&*explorer, &json!({}));
    assert_eq!(
        (&again.facts, figure(&again, "error")),
        (&initial.facts, figure(&initial, "error"))
    );
}

#[test]
fn outliers_show_as_rejected_with_the_default_and_stay_in_with_the_plain_filter() {
    let explorer = (SOURCE.open_bundled)("faults").unwrap();
    let far = |filter: &str| {
        let answer = answered(&*explorer, &json!({ "filter": filter }));
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
fn a_recording_needs_its_files() {
    let sentence = (SOURCE.open)(&crate::explore::Files::default()).err().unwrap().to_string();
    assert_eq!(sentence, "a file is needed: obs");
}

#[test]
fn the_first_epoch_alone_can_be_looked_at() {
    let explorer = (SOURCE.open_bundled)("clean").unwrap();
    let answer = answered(&*explorer, &json!({ "until": 0.0 }));
    assert_eq!(figure(&answer, "error").series[0].x.len(), 1);
}
