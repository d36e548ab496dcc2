use std::fmt::Write as _;
use std::fs;

use serde_json::{Map, Value, json};

use super::*;
use crate::explore::{Answer, Settings};

fn answer(explorer: &dyn Explorer, sent: &Value) -> Answer {
    let sent: &Map<String, Value> = sent.as_object().unwrap();
    let settings = Settings::sent(&explorer.controls(), sent).unwrap();
    explorer.answer(&settings).unwrap()
}

fn values<'a>(answer: &'a Answer, figure: &str, series: &str) -> &'a [f64] {
    let figure = answer.figures.iter().find(|found| found.id == figure).unwrap();
    &figure.series.iter().find(|found| found.name == series).unwrap().y
}

#[test]
fn bundled_flights_answer_with_the_same_figures_whatever_the_settings() {
    for (name, _) in SOURCE.bundled {
        let explorer = (SOURCE.open_bundled)(name).unwrap();
        let ids = |sent: Value| -> Vec<String> {
            let answer = answer(&*explorer, &sent);
            assert!(answer.warnings.is_empty(), "{:?}", answer.warnings);
            answer.figures.into_iter().map(|figure| figure.id).collect()
        };
        let first = ids(json!({}));
        assert_eq!(
            first,
            ["alpha", "pitch-rate", "airspeed", "pitch", "error", "poles", "against"]
        );
        for sent in [
            json!({ "noise": "none", "gain": "varying", "wrong": 0 }),
            json!({ "outputs": "Vtheta", "plant": "P3", "scalar": "fixed", "noise": "sensors" }),
            json!({ "outputs": "qVtheta", "plant": "P1", "duration": 60, "scalar": "f32" }),
        ] {
            assert_eq!(ids(sent), first);
        }
    }
    assert!((SOURCE.open_bundled)("cosine").is_err());
}

#[test]
fn a_slider_moves_what_it_is_for_and_nothing_else() {
    let explorer = (SOURCE.open_bundled)("constant").unwrap();
    let first = answer(&*explorer, &json!({}));
    let faster = answer(&*explorer, &json!({ "faster": 4 }));
    assert_ne!(values(&first, "alpha", "Luenberger"), values(&faster, "alpha", "Luenberger"));
    assert_eq!(values(&first, "alpha", "Kalman"), values(&faster, "alpha", "Kalman"));
    let trusting = answer(&*explorer, &json!({ "ratio": 0.01 }));
    assert_ne!(values(&first, "pitch", "Kalman"), values(&trusting, "pitch", "Kalman"));
    assert_eq!(values(&first, "pitch", "truth"), values(&trusting, "pitch", "truth"));
    let seeded = answer(&*explorer, &json!({ "seed": 1 }));
    assert_ne!(values(&first, "pitch", "truth"), values(&seeded, "pitch", "truth"));
}

#[test]
fn without_noise_the_poles_are_where_the_sliders_put_them() {
    let explorer = (SOURCE.open_bundled)("sine").unwrap();
    let sent =
        json!({ "noise": "none", "pole_1": -12, "pole_2": -14, "pole_3": -16, "pole_4": -18 });
    let answer = answer(&*explorer, &sent);
    let poles = answer.figures.iter().find(|figure| figure.id == "poles").unwrap();
    let observer = poles.series.iter().find(|series| series.name == "Luenberger").unwrap();
    let mut found = observer.x.clone();
    found.sort_by(f64::total_cmp);
    for (found, asked) in found.iter().zip([-18.0, -16.0, -14.0, -12.0]) {
        assert!((found - asked).abs() < 1e-6, "{found}");
    }
    let caught = answer.facts.iter().find(|(name, _)| name.contains("Luenberger: caught"));
    assert_eq!(caught.unwrap().1, "0.25 0.22 0.25 0.19");
}

#[test]
fn an_observer_that_is_missing_is_explained() {
    let explorer = (SOURCE.open_bundled)("constant").unwrap();
    for (outputs, scalar, pole) in [
        ("Vtheta", "f64", -3.0),
        ("Vtheta", "fixed", -30.0),
        ("qVtheta", "fixed", -30.0),
        ("all", "f32", -30.0),
    ] {
        let sent = json!({
            "outputs": outputs, "scalar": scalar, "faster": 10, "plant": "P1",
            "pole_1": pole, "pole_2": pole, "pole_3": pole, "pole_4": pole,
        });
        let answer = answer(&*explorer, &sent);
        let missing = values(&answer, "alpha", "Luenberger").is_empty();
        let told = answer.warnings.iter().any(|warning| warning.contains("Luenberger"));
        assert_eq!(missing, told, "{outputs} {scalar}: {:?}", answer.warnings);
        assert!(!values(&answer, "alpha", "Kalman").is_empty());
    }
}

#[test]
fn a_log_is_followed_and_refused_as_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("flight.csv");
    let mut text = "t,delta_e,delta_t,q,V,theta\n".to_owned();
    for k in 0..200 {
        let t = f64::from(k) * 0.01;
        let (sine, cosine) = t.sin_cos();
        let (rate, pitch) = (0.01 * sine, 0.02 * sine);
        writeln!(text, "{t:.2},0,0,{rate:.6},{cosine:.6},{pitch:.6}").unwrap();
    }
    fs::write(&log, text).unwrap();
    let mut files = Files::default();
    assert!((SOURCE.open)(&files).is_err());
    files.add("log", &log);
    let explorer = (SOURCE.open)(&files).unwrap();
    let first = answer(&*explorer, &json!({}));
    assert_eq!(values(&first, "airspeed", "measured").len(), 200);
    assert!(values(&first, "alpha", "measured").is_empty());
    assert_eq!(values(&first, "alpha", "Kalman").len(), 200);
    let other = answer(&*explorer, &json!({ "plant": "P3", "faster": 2 }));
    assert_ne!(values(&first, "alpha", "Luenberger"), values(&other, "alpha", "Luenberger"));
    let settings = Settings::sent(
        &explorer.controls(),
        json!({ "absolute": true, "plant": "P2" }).as_object().unwrap(),
    );
    let refusal = explorer.answer(&settings.unwrap()).unwrap_err().to_string();
    assert!(refusal.contains("needs a model with a trim"), "{refusal}");
    fs::write(&log, "t,delta_e,delta_t,q\n0,0,0,x\n").unwrap();
    let refusal = (SOURCE.open)(&files).err().unwrap().to_string();
    assert!(refusal.contains("line 2"), "{refusal}");
}
