use std::fmt::Write as _;
use std::fs;

use serde_json::{Value, json};

use super::*;
use crate::explore::Answer;

const IDS: [&str; 4] = ["map", "error", "spread", "path-loss"];

fn answer(explorer: &dyn Explorer, sent: &Value) -> Answer {
    let settings = Settings::sent(&explorer.controls(), sent.as_object().unwrap()).unwrap();
    explorer.answer(&settings).unwrap()
}

fn points(answer: &Answer, figure: &str, series: &str) -> Vec<(f64, f64)> {
    let figure = answer.figures.iter().find(|found| found.id == figure).unwrap();
    let series = figure.series.iter().find(|found| found.name == series).unwrap();
    series.x.iter().copied().zip(series.y.iter().copied()).collect()
}

fn ids(answer: &Answer) -> Vec<&str> {
    answer.figures.iter().map(|figure| figure.id.as_str()).collect()
}

#[test]
fn bundled_flights_answer_with_the_same_figures_whatever_the_settings() {
    let staying = [
        json!({}),
        json!({ "filter": "paper", "resampler": "residual", "trajectory": "grid", "step": 1 }),
        json!({ "trajectory": "small", "environment": "high", "measurements": 40, "step": 40 }),
    ];
    let moving = [
        json!({ "end_time": 100 }),
        json!({ "end_time": 100, "flight": "hover", "user_radius": 0, "step": 1000 }),
        json!({ "end_time": 100, "flight": "low", "environment": "suburban", "noise": 2 }),
    ];
    for (name, all) in [("staying", staying), ("moving", moving)] {
        let explorer = (SOURCE.open_bundled)(name).unwrap();
        for sent in all {
            let answer = answer(&*explorer, &sent);
            assert_eq!(ids(&answer), IDS, "{sent}");
            assert!(!points(&answer, "map", "particles").is_empty(), "{sent}");
        }
    }
    assert!((SOURCE.open_bundled)("flying").is_err());
}

#[test]
fn stepping_moves_the_cloud_and_nothing_that_is_over_all_steps() {
    let explorer = (SOURCE.open_bundled)("moving").unwrap();
    let at = |step: u32| answer(&*explorer, &json!({ "end_time": 100, "step": step }));
    let (early, late) = (at(3), at(80));
    assert_ne!(points(&early, "map", "particles"), points(&late, "map", "particles"));
    assert_eq!(points(&early, "error", "error"), points(&late, "error", "error"));
    assert_eq!(points(&late, "map", "drone").len(), 80);
    let other = answer(&*explorer, &json!({ "end_time": 100, "step": 80, "seed": 3 }));
    assert_ne!(points(&late, "error", "error"), points(&other, "error", "error"));
}

#[test]
fn the_cloud_gathers_where_the_user_is() {
    let explorer = (SOURCE.open_bundled)("staying").unwrap();
    for filter in ["best", "paper"] {
        let sent = json!({ "filter": filter, "measurements": 40, "step": 40 });
        let answer = answer(&*explorer, &sent);
        let spread = points(&answer, "spread", "spread, m");
        assert!(spread[39].1 < spread[0].1 / 2.0, "{filter}: {spread:?}");
        assert!(points(&answer, "error", "error")[39].1 < 400.0, "{filter}");
    }
}

#[test]
fn a_log_is_searched_and_refused_as_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let (log, truth) = (folder.path().join("stops.csv"), folder.path().join("truth.csv"));
    let mut text = "t,x,y,h,rssi_db\n".to_owned();
    for k in 0..12 {
        let t = f64::from(k);
        let (x, y) = (40.0 * t, 30.0 * (t * 0.9).sin());
        let far = (x - 200.0).hypot(y - 100.0).hypot(40.0);
        writeln!(text, "{t},{x:.3},{y:.3},40,{:.3}", -40.0 - 20.0 * far.log10()).unwrap();
    }
    fs::write(&log, text).unwrap();
    fs::write(&truth, "x,y\n200,100\n").unwrap();
    let mut files = Files::default();
    assert!((SOURCE.open)(&files).is_err());
    files.add("log", &log);
    files.add("truth", &truth);
    let explorer = (SOURCE.open)(&files).unwrap();
    let first = answer(&*explorer, &json!({ "step": 1 }));
    let last = answer(&*explorer, &json!({}));
    assert_eq!(ids(&last), IDS);
    assert_ne!(points(&first, "map", "particles"), points(&last, "map", "particles"));
    assert!(points(&last, "error", "Error")[11].1 < 60.0);
    fs::write(&log, "t,x,y,h,rssi_db\n0,0,0,40,-60\n").unwrap();
    let refusal = (SOURCE.open)(&files).err().unwrap().to_string();
    assert!(refusal.contains("at least three measurements"), "{refusal}");
}
