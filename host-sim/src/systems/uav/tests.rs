use std::fmt::Write as _;
use std::fs;
use std::sync::Arc;

use serde_json::{Value, json};

use super::*;
use crate::system::{AnySystem, Opened, Source};

fn open(name: &str) -> Box<dyn Opened> {
    let settings = Settings::new(settings::table());
    Uav.open(Source::Synthetic(name.to_owned()), &settings).unwrap()
}

fn tried(opened: &dyn Opened, sent: &Value) -> Result<Arc<Answer>, Error> {
    let sent = sent.as_object().cloned().unwrap_or_default();
    opened.answer(&Settings::sent(opened.settings(), &sent).unwrap())
}

fn answer(opened: &dyn Opened, sent: &Value) -> Arc<Answer> {
    tried(opened, sent).unwrap()
}

fn values<'a>(answer: &'a Answer, figure: &str, series: &str) -> &'a [f64] {
    let figure = answer.figures.iter().find(|found| found.id == figure).unwrap();
    &figure.series.iter().find(|found| found.name == series).unwrap().y
}

#[test]
fn synthetic_flights_answer_with_the_same_figures_whatever_the_settings() {
    for (name, _) in Uav::SYNTHETIC {
        let opened = open(name);
        let ids = |sent: Value| -> Vec<String> {
            let answer = answer(&*opened, &sent);
            assert!(answer.warnings.is_empty(), "{:?}", answer.warnings);
            answer.figures.iter().map(|figure| figure.id.clone()).collect()
        };
        let first = ids(json!({}));
        assert_eq!(
            first,
            [
                "alpha",
                "pitch-rate",
                "airspeed",
                "pitch",
                "error",
                "nis",
                "whiteness",
                "zeros",
                "poles",
                "against"
            ]
        );
        for sent in [
            json!({ "noise": "none", "gain": "varying", "wrong-start": 0 }),
            json!({ "outputs": "V-theta", "model": "P3", "scalar": "fixed", "noise": "sensors" }),
            json!({ "outputs": "q-V-theta", "model": "P1", "duration": 60, "scalar": "f32" }),
        ] {
            assert_eq!(ids(sent), first);
        }
    }
    assert!(Recording::synthetic("cosine").is_err());
}

#[test]
fn a_slider_moves_what_it_is_for_and_nothing_else() {
    let opened = open("constant");
    let observer = |sent: Value| {
        let mut sent = sent;
        sent["estimator"] = "luenberger".into();
        answer(&*opened, &sent)
    };
    let (first, faster) = (observer(json!({})), observer(json!({ "faster": 4 })));
    assert_ne!(values(&first, "alpha", "Luenberger"), values(&faster, "alpha", "Luenberger"));
    assert_eq!(values(&first, "alpha", "Kalman"), values(&faster, "alpha", "Kalman"));
    assert_ne!(first.facts, faster.facts);
    let first = answer(&*opened, &json!({}));
    let trusting = answer(&*opened, &json!({ "ratio": 0.01 }));
    assert_ne!(values(&first, "pitch", "Kalman"), values(&trusting, "pitch", "Kalman"));
    assert_eq!(values(&first, "pitch", "truth"), values(&trusting, "pitch", "truth"));
    let seeded = answer(&*opened, &json!({ "seed": 1 }));
    assert_ne!(values(&first, "pitch", "truth"), values(&seeded, "pitch", "truth"));
}

#[test]
fn what_is_not_disabled_changes_the_answer_and_what_is_does_not() {
    let opened = open("sine");
    let others = json!({
        "estimator": "luenberger", "model": "P3", "poles": "-5,-6,-7+1i,-7-1i", "faster": 2.0, "absolute": true,
        "input-noise": "0.1,0.2", "output-noise": "0.1,0.2,0.3,0.4", "ratio": 3.0, "scalar": "f32",
        "outputs": "q-V-theta", "gain": "varying", "noise": "sensors", "sigma": 0.1, "wrong-start": 2.0,
        "duration": 5.0, "seed": 3,
    });
    let others = others.as_object().unwrap();
    assert_eq!(others.len(), settings::table().len());
    for base in [json!({}), json!({ "estimator": "luenberger", "noise": "none" })] {
        let first = answer(&*opened, &base);
        for (name, value) in others.iter().filter(|(name, value)| base.get(name) != Some(value)) {
            let mut sent = base.clone();
            sent[name] = value.clone();
            let second = answer(&*opened, &sent);
            let is_idle = second.disabled.iter().any(|(idle, _)| idle == name);
            let same = (&first.facts, &first.figures) == (&second.facts, &second.figures);
            assert_eq!(same, is_idle, "{name} beside {base}");
            assert_eq!(second.command.contains(&format!("--{name}")), !is_idle, "{name}");
        }
    }
}

#[test]
fn without_noise_the_poles_are_where_the_setting_puts_them() {
    let sent = json!({ "noise": "none", "estimator": "luenberger", "poles": "-12,-14,-16,-18" });
    let answer = answer(&*open("sine"), &sent);
    let poles = answer.figures.iter().find(|figure| figure.id == "poles").unwrap();
    let observer = poles.series.iter().find(|series| series.name == "Luenberger").unwrap();
    let mut found = observer.x.clone();
    found.sort_by(f64::total_cmp);
    for (found, asked) in found.iter().zip([-18.0, -16.0, -14.0, -12.0]) {
        assert!((found - asked).abs() < 1e-6, "{found}");
    }
    let caught = answer.facts.iter().find(|(name, _)| name.contains("Luenberger, caught"));
    assert_eq!(caught.unwrap().1, "0.25 0.22 0.25 0.19");
}

#[test]
fn an_observer_that_is_missing_is_explained() {
    let opened = open("constant");
    for (outputs, scalar, pole) in [
        ("V-theta", "f64", "-3"),
        ("V-theta", "fixed", "-30"),
        ("q-V-theta", "fixed", "-30"),
        ("all", "f32", "-30"),
    ] {
        let poles = [pole; 4].join(",");
        let mut sent = json!({
            "outputs": outputs, "scalar": scalar, "faster": 10, "model": "P1",
            "estimator": "luenberger", "poles": poles,
        });
        match tried(&*opened, &sent) {
            Ok(answer) => assert!(!values(&answer, "alpha", "Luenberger").is_empty()),
            Err(problem) => assert!(!problem.to_string().contains('\n'), "{problem}"),
        }
        sent["estimator"] = "kalman".into();
        assert!(!values(&answer(&*opened, &sent), "alpha", "Kalman").is_empty());
    }
}

#[test]
fn firmware_says_the_estimator_and_its_scalar() {
    let opened = open("constant");
    for (sent, expected) in [
        (json!({}), "Estimator::<f64, 4>::constant_gain("),
        (json!({ "gain": "varying", "scalar": "f32" }), "Estimator::<f32, 4>::time_varying("),
        (
            json!({ "estimator": "luenberger", "scalar": "fixed", "outputs": "V-theta" }),
            "Estimator::<kestirim_scalar::Q16_16, 2>::constant_gain(",
        ),
    ] {
        let firmware = answer(&*opened, &sent).firmware.clone();
        assert!(firmware.contains(expected), "{firmware}");
    }
    let settings = Settings::new(settings::table());
    assert!(firmware::firmware(None, &settings).contains("FlightFilter::<f64, 3>::new("));
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
    let settings = Settings::new(settings::table());
    let mut files = Files::default();
    assert!(Recording::read(&files).is_err());
    files.add("log", &log);
    let opened = Uav.open(Source::Files(files.clone()), &settings).unwrap();
    let first = answer(&*opened, &json!({}));
    assert!(first.warnings[0].contains("P2 thesis-like is assumed"), "{:?}", first.warnings);
    assert_eq!(values(&first, "airspeed", "measured").len(), 200);
    assert!(values(&first, "alpha", "measured").is_empty());
    assert_eq!(values(&first, "alpha", "Kalman").len(), 200);
    let other = answer(&*opened, &json!({ "model": "P3", "scalar": "f32" }));
    assert_ne!(values(&first, "alpha", "Luenberger"), values(&other, "alpha", "Luenberger"));
    // A flight that no aircraft can have flown.
    assert!(
        other.warnings.iter().all(|it| it.contains("contradicts the model")),
        "{:?}",
        other.warnings
    );
    let track = folder.path().join("track.csv");
    let wanted = crate::system::Wanted { tables: vec![("track", track.clone())], mcap: None };
    for (model, state) in [("P2", "good"), ("P3", "bad")] {
        let sent = json!({ "model": model });
        let settings = Settings::sent(opened.settings(), sent.as_object().unwrap()).unwrap();
        assert_eq!(opened.replay(&settings, &wanted).unwrap().report["health"]["state"], state);
        let rows = fs::read_to_string(&track).unwrap();
        assert_eq!(rows.lines().skip(1).filter(|row| row.ends_with(state)).count(), 200);
    }
    for (name, value) in [("absolute", json!(true)), ("seed", json!(3))] {
        let sent = json!({ "model": "P2", name: value });
        let settings = Settings::sent(opened.settings(), sent.as_object().unwrap()).unwrap();
        let refusal = opened.replay(&settings, &crate::system::Wanted::default());
        assert!(refusal.unwrap_err().to_string().contains(name));
        assert!(answer(&*opened, &sent).disabled.iter().any(|(idle, _)| *idle == name));
    }
    fs::write(&log, "t,delta_e,delta_t,q\n0,0,0,x\n").unwrap();
    let refusal = Recording::read(&files).unwrap_err().to_string();
    assert!(refusal.contains("line 2"), "{refusal}");
}
