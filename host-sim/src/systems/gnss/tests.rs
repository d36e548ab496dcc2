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
        let expected = [
            "error",
            "sigma",
            "components",
            "plan",
            "sky",
            "dilution",
            "satellites",
            "residuals",
            "phases",
            "code-elevation",
            "phase-elevation",
        ];
        assert_eq!(ids, expected, "{name}");
        assert!(answer.facts.iter().any(|(name, _)| name == "final error"), "{:?}", answer.facts);
        // With faults, a tenth of an epoch's observations may be rejected.
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
        (json!({}), json!({ "method": "single" }), "error"),
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
    // Earlier requests leave no trace.
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
        (used.filter(|residual| residual.abs() > figures::residuals::FAR).count(), rejected.x.len())
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

/// The column of a table, by name.
fn column(answer: &Answer, name: &str) -> Vec<f64> {
    let sheet = &answer.tables[0];
    let place = sheet.header.iter().position(|it| it == name).unwrap();
    sheet.rows.iter().map(|row| row[place].parse().unwrap()).collect()
}

#[test]
fn satellites_are_where_they_were_seen() {
    let opened = open("clean");
    let answer = answered(&*opened, &json!({}));
    let sky = figure(&answer, "sky");
    let tracks: Vec<_> = sky.series.iter().filter(|it| it.name.starts_with('G')).collect();
    assert_eq!(tracks.len(), answer.tables[0].rows.len());
    let mask = sky.series.iter().find(|it| it.name == "mask").unwrap();
    let far = |series: &crate::figure::Series| -> Vec<f64> {
        let all = series.x.iter().zip(&series.y).map(|(x, y)| x.hypot(*y));
        all.filter(|it| it.is_finite()).collect()
    };
    assert!(far(mask).iter().all(|it| (it - 82.0).abs() < 1e-9), "8° above the horizon");
    let names = sky.series.iter().find(|it| it.name == "names").unwrap();
    for track in tracks {
        assert!(far(track).iter().all(|it| *it <= 82.0 + 1e-9), "{}", track.name);
        // Each time has a position, and no satellite moves by more than a degree in a minute.
        let times = track.times.as_ref().unwrap();
        assert!(times.len() == track.x.len() && times.is_sorted());
        for place in 1..times.len() {
            let step =
                (track.x[place] - track.x[place - 1]).hypot(track.y[place] - track.y[place - 1]);
            assert!(step.is_nan() || step < 1.0, "{} {step}", track.name);
        }
        let labels = names.labels.as_ref().unwrap();
        let named = labels.iter().position(|it| *it == track.name).unwrap();
        let nearest = track.x.iter().zip(&track.y);
        let nearest = nearest.map(|(x, y)| (x - names.x[named]).hypot(y - names.y[named]));
        assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-9);
    }
}

#[test]
fn dilution_follows_the_number_of_satellites() {
    let opened = open("clean");
    let of = |mask: f64| {
        let answer = answered(&*opened, &json!({ "mask": mask }));
        let series = &figure(&answer, "dilution").series;
        let middle = |name: &str| {
            let series = series.iter().find(|it| it.name == name).unwrap();
            let known: Vec<_> = series.y.iter().copied().filter(|it| it.is_finite()).collect();
            crate::metrics::median(&known)
        };
        ["satellites used", "GDOP", "PDOP", "HDOP", "VDOP"].map(middle)
    };
    let [used, geometric, position, horizontal, vertical] = of(8.0);
    // Typical values of GPS under an open sky.
    assert!((7.0..13.0).contains(&used) && (1.2..3.5).contains(&position), "{used} {position}");
    assert!(geometric > position && position > vertical && vertical > horizontal);
    let [fewer, greater, ..] = of(25.0);
    assert!(fewer < used && greater > 1.5 * geometric, "{fewer} {greater} {geometric}");
}

#[test]
fn the_table_of_satellites_counts_what_the_facts_count() {
    let opened = open("faults");
    let answer = answered(&*opened, &json!({}));
    let fact = |name: &str| &answer.facts.iter().find(|(is, _)| is == name).unwrap().1;
    let (shares, slips) = (column(&answer, "codes rejected, %"), column(&answer, "slips"));
    let phases = column(&answer, "phases rejected, %");
    let told: f64 = fact("slips")
        .split(", ")
        .map(|it| it.split(' ').next().unwrap().parse::<f64>().unwrap())
        .sum();
    assert_eq!(slips.iter().sum::<f64>(), told, "{}", fact("slips"));
    let most = fact("  most of").split(' ').next().unwrap();
    assert!(answer.tables[0].rows.iter().take(4).any(|row| row[0] == most), "{most}");
    let sums: Vec<_> = shares.iter().zip(&phases).map(|(a, b)| a + b).collect();
    assert!(sums.windows(2).all(|pair| pair[0] >= pair[1] - 0.11), "{sums:?}");
    // The noise of the synthetic sky: decimetres to a metre or two, and millimetres to some centimetres.
    assert!(column(&answer, "RMS of codes, m").iter().all(|it| (0.1..3.0).contains(it)));
    assert!(column(&answer, "RMS of phases, mm").iter().all(|it| (1.0..60.0).contains(it)));
}

#[test]
fn bands_are_of_the_reported_deviations_and_axes_tell_utc() {
    let opened = open("clean");
    let answer = answered(&*opened, &json!({}));
    let components = figure(&answer, "components");
    assert_eq!(components.x.label, "time, h since 2019-08-31 23:59:42 UTC");
    let of = |figure: &'static str, name: &str| {
        let series = &self::figure(&answer, figure).series;
        series.iter().find(|it| it.name == name).unwrap().y.clone()
    };
    for axis in ["east", "north", "up"] {
        let [low, high] = ["−", "+"].map(|sign| of("components", &format!("{axis} {sign} 95 %")));
        let (is, sigma) = (of("components", axis), of("sigma", axis));
        assert!(is.len() == 960 && low.len() == 960);
        for (place, sigma) in sigma.into_iter().enumerate() {
            assert!((high[place] - is[place] - 1.96 * sigma).abs() < 1e-12, "{axis} {place}");
            assert!((is[place] - low[place] - 1.96 * sigma).abs() < 1e-12, "{axis} {place}");
        }
    }
    let (_, ends) = answer.facts.iter().find(|(name, _)| name == "first, last epoch").unwrap();
    assert_eq!(ends, "2019-08-31 23:59:42 UTC, 2019-09-01 07:59:12 UTC");
}

#[test]
fn a_plan_says_how_long_a_round_bar_is() {
    let opened = open("clean");
    let answer = answered(&*opened, &json!({}));
    let plan = figure(&answer, "plan");
    assert_eq!([&plan.x.label, &plan.y.label], ["east of the truth, m", "north of the truth, m"]);
    let bar = plan.series.last().unwrap();
    let label = &bar.labels.as_ref().unwrap()[2];
    let (number, unit) = label.split_once(' ').unwrap();
    let unit =
        [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0)].into_iter().find(|it| it.0 == unit).unwrap().1;
    let length: f64 = number.parse::<f64>().unwrap() * unit;
    assert!((bar.x[3] - bar.x[1] - length).abs() < 1e-9, "{label}");
}
