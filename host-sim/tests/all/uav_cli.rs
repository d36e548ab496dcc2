//! Tests of the UAV's commands: exit status, standard output, standard error, files.

use std::process::Command;

use host_sim::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, Sample, fly};
use kestirim_replay::uav::{Noise, Plant};
use serde_json::Value;

use crate::program::{Desk, host_sim, json, messages, refusal, rows_of, text};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|it| it.as_f64().expect("a number")).collect()
}

/// The row of a table with these values of its fields.
fn row<'a>(report: &'a Value, table: &str, fields: &[(&str, Value)]) -> &'a Value {
    let mut rows = report[table].as_array().expect("rows").iter();
    let found = rows.find(|row| fields.iter().all(|(name, value)| row[name] == *value));
    found.unwrap_or_else(|| panic!("no row {fields:?} in {table}"))
}

#[test]
fn the_thesis_is_reproduced() {
    let report = json(&host_sim(&["run", "uav", "--json", "--scalar", "f64"]));
    assert_eq!((&report["system"], &report["scalar"]), (&"uav".into(), &"f64".into()));
    // The times to catch, as on the card.
    for (published, ours, limit) in [
        ("Figs 6.1–6.4", [5.0, 5.2, 5.4, 8.6], 0.05),
        ("Figs 6.13–6.17", [1.5, 2.0, 0.49, 0.94], 0.005),
        ("Fig. 6.25", [0.25, 0.22, 0.25, 0.19], 0.005),
    ] {
        let row = row(&report, "catching", &[("source", published.into())]);
        for (found, expected) in numbers(&row["ours_s"]).iter().zip(ours) {
            assert!((found - expected).abs() <= limit, "{published}: {found} {expected}");
        }
        assert_eq!(row["ours_s"], row["limit_s"]);
    }
    // The errors are as predicted.
    for row in report["accuracy"].as_array().expect("rows") {
        let pairs = numbers(&row["rmse"]).into_iter().zip(numbers(&row["predicted"]));
        for (found, predicted) in pairs {
            assert!((found / predicted - 1.0).abs() < 0.05, "{row}");
        }
        assert_eq!(row["refused"], 0);
    }
    // The errors do not depend on u.
    for row in report["independence"].as_array().expect("rows") {
        let (largest, difference) = (numbers(&row["largest_error"]), numbers(&row["difference"]));
        assert!(largest.iter().zip(difference).all(|(all, part)| part < 1e-12 * all), "{row}");
    }
    let holds = |setting: &str| {
        row(&report, "claims", &[("setting", setting.into())])["holds"]
            .as_bool()
            .expect("a verdict")
    };
    assert!(holds("settled, the filter for the noise there is"));
    assert!(!holds("settled, the gain that explains the thesis' figures"));
    assert!(!holds("10 s from a wrong start, steady-state gain"));
    assert!(holds("10 s from a wrong start, time-varying gain"));
    assert!(holds("the gain that explains the thesis' figures"));
    assert!(!holds("time-varying gain"));
}

#[test]
fn every_scalar_tells_the_same() {
    let caught = |scalar: &str| {
        let run = ["run", "uav", "--json", "--trials", "50", "--scalar", scalar];
        let report = json(&host_sim(&run));
        let rows = report["catching"].as_array().expect("rows").clone();
        let accuracy = report["accuracy"].as_array().expect("rows").clone();
        (rows, accuracy)
    };
    let (exact, exact_errors) = caught("f64");
    for (scalar, seconds, share) in [("f32", 0.021, 1e-3), ("fixed", 0.07, 0.02)] {
        let (rows, errors) = caught(scalar);
        for (ours, exact) in rows.iter().zip(&exact) {
            let pairs = ours["ours_s"].as_array().expect("times").iter();
            for (ours, exact) in pairs.zip(exact["ours_s"].as_array().expect("times")) {
                let (ours, exact) = (ours.as_f64(), exact.as_f64());
                let apart = ours.zip(exact).map_or(0.0, |(a, b)| (a - b).abs());
                assert!(ours.is_some() == exact.is_some() && apart < seconds, "{scalar}");
            }
        }
        for (ours, exact) in errors.iter().zip(&exact_errors) {
            let pairs = numbers(&ours["rmse"]).into_iter().zip(numbers(&exact["rmse"]));
            for (found, exact) in pairs {
                assert!((found / exact - 1.0).abs() < share, "{scalar}: {ours}");
            }
        }
    }
}

#[test]
fn the_answer_depends_on_the_seed_and_not_on_the_threads() {
    let run = |threads: &str, seed: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
        let arguments = ["run", "uav", "--trials", "20", "--json", "--seed"];
        command.args(arguments).arg(seed).env("RAYON_NUM_THREADS", threads);
        command.output().expect("the program runs").stdout
    };
    assert_eq!(run("1", "7"), run("3", "7"));
    assert_ne!(run("1", "7"), run("1", "8"));
}

/// Ten seconds of a noisy flight of P2, including its true states.
fn flight() -> Vec<Sample> {
    let plant = Plant::P2.discrete(INTERVAL_S);
    let start = [0.0, 0.0, 40.0, 0.53].into();
    let rng = host_sim::random::stream(3, 0);
    fly(plant, start, Inputs::Sine, Noise::SENSORS, rng).take(1000).collect()
}

fn csv(header: &str, samples: &[Sample], line: impl Fn(&Sample) -> String) -> String {
    let line = |(k, sample): (usize, &Sample)| format!("{:.2},{}\n", k as f64 * 0.01, line(sample));
    header.to_owned() + "\n" + &samples.iter().enumerate().map(line).collect::<String>()
}

fn log_of(samples: &[Sample]) -> String {
    csv("t,delta_e,delta_t,q,V,theta", samples, |Sample { u, y, .. }| {
        format!("{},{},{},{},{}", u[0], u[1], y[1], y[2], y[3])
    })
}

fn truth_of(samples: &[Sample]) -> String {
    csv("t,alpha,q,V,theta", samples, |Sample { x, .. }| {
        format!("{},{},{},{}", x[0], x[1], x[2], x[3])
    })
}

#[test]
fn a_flight_is_replayed() {
    let desk = Desk::new();
    let samples = flight();
    let log = desk.file("flight.csv", log_of(&samples));
    let truth = desk.file("truth.csv", truth_of(&samples));
    let track = desk.named("track.csv");
    let files = ["replay", "uav", "--log", &log, "--model", "P2", "--truth", &truth];
    let report = json(&host_sim(&[&files[..], &["--track", &track, "--json"]].concat()));
    assert_eq!((&report["system"], &report["samples"]), (&"uav".into(), &1000.into()));
    assert_eq!((&report["gaps"], &report["interval_s"]), (&0.into(), &0.01.into()));
    // Once settled, the filter is as accurate as predicted before a measurement (4.7e-4, 9.5e-3, 6.7e-2, 8.6e-4), or
    // better because of it.
    let late = numbers(&report["accuracy"]["late_rmse"]);
    for (found, limit) in late.iter().zip([8e-4, 1.1e-2, 0.11, 1.4e-3]) {
        assert!(*found < limit, "{late:?}");
    }
    let (header, rows) = rows_of::<9>(&track);
    assert_eq!(header, "t,alpha,q,V,theta,s_alpha,s_q,s_V,s_theta,health");
    assert_eq!((rows.len(), rows[0].0[0]), (1000, 0.0));
    let (last, health) = &rows[999];
    assert_eq!(health, "good");
    for (sigma, error) in last[5..].iter().zip(&late) {
        assert!((0.5..2.0).contains(&(sigma / error)), "{sigma} says the filter of {error}");
    }
    let observer = |poles: &[&str]| {
        let more = [&["--estimator", "luenberger", "--json"], poles].concat();
        numbers(&json(&host_sim(&[&files[..], &more].concat()))["accuracy"]["late_rmse"])
    };
    let (middle, fast) = (observer(&[]), observer(&["--poles", "-12,-14,-16,-18"]));
    assert!(middle.iter().zip(&late).all(|(observer, filter)| observer > filter));
    assert!(fast[0] > middle[0] && fast[0] < 0.012, "{fast:?}");
    let complex = observer(&["--poles", "-3+2i,-3-2i,-5,-6"]);
    assert!(complex[3] < 0.01);
    assert!(text(&host_sim(&files).stdout).contains("RMSE of alpha"));
}

#[test]
fn gaps_and_empty_fields_are_bridged() {
    let desk = Desk::new();
    let samples = flight();
    let whole = log_of(&samples);
    let mut lines: Vec<String> = whole.lines().map(str::to_owned).collect();
    // Every third airspeed is missing, and half a second of everything.
    for line in lines.iter_mut().skip(1).step_by(3) {
        let mut fields: Vec<&str> = line.split(',').collect();
        fields[4] = "";
        *line = fields.join(",");
    }
    lines.drain(400..450);
    let log = desk.file("flight.csv", lines.join("\n"));
    let truth = desk.file("truth.csv", truth_of(&samples));
    for estimator in ["kalman", "luenberger"] {
        let files = ["replay", "uav", "--log", &log, "--model", "P2", "--truth", &truth];
        let report = json(&host_sim(&[&files[..], &["--estimator", estimator, "--json"]].concat()));
        assert_eq!((&report["samples"], &report["gaps"]), (&950.into(), &1.into()));
        assert!(report["missing"].as_u64().is_some_and(|missing| missing > 300));
        // The input of the line before the gap is held through it, unlike in the actual flight.
        let late = numbers(&report["accuracy"]["late_rmse"]);
        assert!(late[0] < 0.01 && late[3] < 0.02, "{late:?}");
    }
}

#[test]
fn a_model_can_come_from_a_file() {
    let desk = Desk::new();
    let samples = flight();
    let log = desk.file("flight.csv", log_of(&samples));
    let replay = |model: &str, more: &[&str]| {
        let files = ["replay", "uav", "--log", &log, "--model", model, "--json"];
        json(&host_sim(&[&files[..], more].concat()))["estimate"].clone()
    };
    let rows = "\"A\": [[-1.79, 1, -0.0076, -0.017107775185746733], [-25, -20, -0.02, 0], \
                [2, 0, -0.0267, -9.786103333048876], [0, 1, 0, 0]], \
                \"B\": [[0.3, -0.158], [-100, -3], [0.3, 45], [0, 0]]";
    let continuous = desk.file("p2.json", format!("{{{rows}}}"));
    assert_eq!(replay(&continuous, &[]), replay("P2", &[]));
    // Relative to a steady flight of all zeros, absolute values are deviations.
    let trim = "\"trim\": {\"x\": [0, 0, 0, 0], \"u\": [0, 0]}";
    let absolute = desk.file("trim.json", format!("{{{rows}, {trim}}}"));
    assert_eq!(replay(&absolute, &["--absolute"]), replay("P2", &[]));
    let named = format!("{{{rows}, \"C\": [[0, 0, 1, 0]], \"outputs\": [\"V\"]}}");
    let airspeed = desk.file("airspeed.json", named);
    assert_ne!(replay(&airspeed, &[]), replay("P2", &[]));
    // The same model in discrete time.
    let discrete = Plant::P2.discrete(INTERVAL_S);
    let list = |rows: Vec<Vec<f64>>| serde_json::to_string(&rows).expect("numbers");
    let a = list((0..4).map(|i| (0..4).map(|k| discrete.a[(i, k)]).collect()).collect());
    let b = list((0..4).map(|i| (0..2).map(|k| discrete.b[(i, k)]).collect()).collect());
    let file = desk.file("discrete.json", format!("{{\"A\": {a}, \"B\": {b}, \"h\": 0.01}}"));
    let (ours, exact) = (numbers(&replay(&file, &[])), numbers(&replay("P2", &[])));
    assert!(ours.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-3), "{ours:?} {exact:?}");
    let slower = desk.file("slower.json", format!("{{\"A\": {a}, \"B\": {b}, \"h\": 0.02}}"));
    let sentence = refusal(&["replay", "uav", "--log", &log, "--model", &slower]);
    assert!(sentence.contains("0.02 s"), "{sentence}");
}

#[test]
fn a_trim_is_taken_off_and_put_back() {
    let desk = Desk::new();
    // The Aerosonde in level flight with its exact trim: the result is the trim itself.
    let line = |k: u32| {
        format!(
            "{:.2},-0.0346972179928,0.5400719021538,-0.0158720815884,0,40,0.0539410884914\n",
            f64::from(k) * 0.02
        )
    };
    let rows: String = (0..200).map(line).collect();
    let log = desk.file("steady.csv", "t,delta_e,delta_t,alpha,q,V,theta\n".to_owned() + &rows);
    let files = ["replay", "uav", "--log", &log, "--model", "P1"];
    let report = json(&host_sim(&[&files[..], &["--absolute", "--json"]].concat()));
    let estimate = numbers(&report["estimate"]);
    assert!((estimate[2] - 40.0).abs() < 1e-6 && (estimate[3] - 0.053_941_088_491_4).abs() < 1e-8);
    assert_eq!(report["warnings"].as_array().map(Vec::len), Some(0));
    let file = desk.named("steady.mcap");
    json(&host_sim(&[&files[..], &["--absolute", "--json", "--mcap", &file]].concat()));
    for topic in ["/uav/inputs", "/uav/sensors", "/uav/estimate"] {
        assert_eq!(messages(&file).get(topic), Some(&200), "{topic}");
    }
    // The same aircraft by its published coefficients.
    let flown = r#"{"airframe": "aerosonde", "airspeed": 40, "climb_angle": 0.06981317007977318, "note": 1}"#;
    let model = desk.file("aerosonde.json", flown);
    let output =
        host_sim(&["replay", "uav", "--log", &log, "--model", &model, "--absolute", "--json"]);
    assert!(text(&output.stderr).contains("not used: note"), "{}", text(&output.stderr));
    let estimate = numbers(&json(&output)["estimate"]);
    assert!((estimate[2] - 40.0).abs() < 1e-3 && (estimate[3] - 0.053_941_088).abs() < 1e-5);
    // The same by models at three airspeeds, with the flight at the middle one.
    let grid = flown.replace("40,", "[36, 40, 44],").replace(", \"note\": 1", "");
    let model = desk.file("grid.json", grid);
    let files_of_grid = ["replay", "uav", "--log", &log, "--model", &model];
    let report = json(&host_sim(&[&files_of_grid[..], &["--absolute", "--json"]].concat()));
    let of_grid = numbers(&report["estimate"]);
    assert!(estimate.iter().zip(&of_grid).all(|(one, of_grid)| (one - of_grid).abs() < 1e-4));
    assert!(refusal(&files_of_grid).contains("add --absolute"));
    let observer = ["--absolute", "--estimator", "luenberger"];
    let sentence = refusal(&[&files_of_grid[..], &observer].concat());
    assert!(sentence.contains("--estimator kalman"), "{sentence}");
    let warned = host_sim(&files);
    assert!(text(&warned.stderr).contains("--absolute"));
    let sentence = refusal(&["replay", "uav", "--log", &log, "--model", "P2", "--absolute"]);
    assert!(sentence.contains("trim"));
}

#[test]
fn wrong_input_is_refused_with_a_sentence() {
    let desk = Desk::new();
    let log = desk.file("flight.csv", log_of(&flight()));
    let named = |contents: &str| {
        let file = desk.file("wrong.csv", contents);
        refusal(&["replay", "uav", "--strict", "--log", &file, "--model", "P2"])
    };
    assert!(named("").contains("empty"));
    assert!(named("t,delta_e,q\n").contains("delta_t"));
    assert!(named("t,delta_e,delta_t\n0,0,0\n").contains("alpha"));
    assert!(named("t,delta_e,delta_t,q,q\n0,0,0,1,2\n").contains("two"));
    assert!(named("t,delta_e,delta_t,q\n0,0,0,1\n").contains("two samples"));
    assert!(named("t,delta_e,delta_t,V,q [m]\n0,0,0,9,1\n").contains("q [m]"));
    assert!(named("t,delta_e,delta_t,q\n0,0,0,1\n0,0,0,1\n").contains("line 3"));
    assert!(named("t,delta_e,delta_t,q\n0,0,0,1\n1,0,0,x\n").contains("line 3"));
    assert!(named("t,delta_e,delta_t,q\n0,0,0,1\n1,0,0,1e9\n").contains("line 3"));
    assert!(named("t,delta_e,delta_t,q\n0,0,0,1\n1,0,,1\n").contains("line 3"));
    assert!(named("t,delta_e,delta_t,q\n0,0,0,1\n1,0,0,1\n3,0,0,1\n").contains("regular"));
    let model = |contents: &str| {
        let file = desk.file("model.json", contents);
        refusal(&["replay", "uav", "--log", &log, "--model", &file])
    };
    assert!(model("{").contains("line 1"));
    assert!(model("{\"A\": [[1]]}").contains("expected a JSON object"));
    assert!(model("{}").contains("A and B, or an airspeed"));
    assert!(model("{\"airframe\": \"aerosonde\"}").contains("an airspeed beside airframe"));
    let both = r#"{"airframe": "aerosonde", "airspeed": 30, "coefficients": {
        "mass": 5, "Jx": 1, "Jy": 1, "Jz": 1, "S_wing": 1, "b": 3, "c": 0.3, "S_prop": 0.1, "k_motor": 50,
        "C_L_alpha": 5, "C_D_0": 0.03, "C_m_alpha": -1, "C_m_q": -12, "C_m_delta_e": -1}}"#;
    assert!(model(both).contains("airframe or coefficients, found both"));
    assert!(model("{\"airframe\": \"aerosonde\", \"airspeed\": 90}").contains("no throttle"));
    let falling = "{\"airframe\": \"aerosonde\", \"airspeed\": [40, 30]}";
    assert!(model(falling).contains("2 to 8 airspeeds"));
    let plant =
        "\"A\": [[-1,0,0,0],[0,-2,0,0],[0,0,-3,0],[0,0,0,-4]], \"B\": [[1,0],[0,1],[0,0],[0,0]]";
    assert!(model(&format!("{{{plant}, \"C\": [[1,0,0,0]]}}")).contains("outputs"));
    assert!(model(&format!("{{{plant}, \"h\": 0}}")).contains("above 0"));
    let unseen = desk.file("unseen.json", format!("{{{plant}}}"));
    let run = ["replay", "uav", "--log", &log, "--model", &unseen, "--estimator", "luenberger"];
    assert!(refusal(&run).contains("flight.csv"));
    assert!(refusal(&["replay", "uav", "--log", &log, "--model", "P4"]).contains("P4"));
    let with = |more: &[&str]| {
        refusal(&[&["replay", "uav", "--log", &log, "--model", "P2"], more].concat())
    };
    assert!(with(&["--poles", "-1,-2,-3,-4"]).contains("luenberger"));
    assert!(with(&["--track", &log]).contains("overwrite"));
    assert!(with(&["--mcap", &log]).contains("overwrite"));
    assert!(with(&["--truth", &desk.named("absent.csv")]).contains("absent.csv"));
    for wrong in [
        &["--estimator", "luenberger", "--poles", "-1,-2,-3"][..],
        &["--estimator", "luenberger", "--poles", "1,-2,-3,-4"],
        &["--estimator", "luenberger", "--input-noise", "1,1"],
        &["--output-noise", "1,1"],
        &["--estimator", "best"],
    ] {
        with(wrong);
    }
    refusal(&["run", "uav", "--trials", "0"]);
}
