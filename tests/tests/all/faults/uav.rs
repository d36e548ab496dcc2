//! Faults of an aircraft's sensors. The flights are synthetic, of P2 with the noise of usual sensors, because no model
//! of a recorded aircraft is known.

use std::path::Path;

use anyhow::Result;
use host_sim::systems::uav::Uav;
use host_sim::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, Sample, fly};
use kestirim_replay::uav::{Noise, Plant};
use serde_json::Value;

use super::table::{Table, one_in};
use super::{Answer, Case, desk, judge, run};

const OUTPUTS: [&str; 3] = ["q", "V", "theta"];

/// A fault of the log, and the model that is given.
type Fault = (&'static str, fn(&mut Table), &'static str);

fn empty(table: &mut Table, name: &str, length: f64) {
    let (column, is_lost) = (table.column(name), table.after_the_middle(length));
    for row in 0..table.rows.len() {
        if is_lost(table, row) {
            table.rows[row][column].clear();
        }
    }
}

const FAULTS: &[Fault] = &[
    (
        "spikes 1 %",
        |it| it.map(&OUTPUTS, |row, v| if one_in(100, row) { v + 20.0 } else { v }),
        "P2",
    ),
    (
        "spikes 10 %",
        |it| it.map(&OUTPUTS, |row, v| if one_in(10, row) { v + 20.0 } else { v }),
        "P2",
    ),
    (
        "spikes 30 %",
        |it| it.map(&OUTPUTS, |row, v| if one_in(3, row) { v + 20.0 } else { v }),
        "P2",
    ),
    ("θ in degrees", |it| it.map(&["theta"], |_, v| v.to_degrees()), "P2"),
    ("q in degrees a second", |it| it.map(&["q"], |_, v| v.to_degrees()), "P2"),
    ("θ and q in degrees", |it| it.map(&["q", "theta"], |_, v| v.to_degrees()), "P2"),
    ("V in knots", |it| it.map(&["V"], |_, v| v * 1.943_844), "P2"),
    ("δe in degrees", |it| it.map(&["delta_e"], |_, v| v.to_degrees()), "P2"),
    ("δe with the other sign", |it| it.map(&["delta_e"], |_, v| -v), "P2"),
    ("δe dead", |it| it.map(&["delta_e"], |_, _| 0.0), "P2"),
    ("q with the other sign", |it| it.map(&["q"], |_, v| -v), "P2"),
    (
        "q stuck from the middle on",
        |it| {
            let last = it.number(it.rows.len() / 2, it.column("q"));
            it.map_from(0.5, &["q"], |_| last);
        },
        "P2",
    ),
    (
        "V stuck from the middle on",
        |it| {
            let last = it.number(it.rows.len() / 2, it.column("V"));
            it.map_from(0.5, &["V"], |_| last);
        },
        "P2",
    ),
    ("θ 0.1 rad off from the middle on", |it| it.map_from(0.5, &["theta"], |v| v + 0.1), "P2"),
    ("q 0.05 rad/s off from the middle on", |it| it.map_from(0.5, &["q"], |v| v + 0.05), "P2"),
    ("dropout 0.2 s", |it| it.drop_out(0.2), "P2"),
    ("dropout 1 s", |it| it.drop_out(1.0), "P2"),
    ("V not measured for 3 s", |it| empty(it, "V", 3.0), "P2"),
    ("outputs 50 ms late", |it| it.late(&OUTPUTS, 5), "P2"),
    ("inputs 100 ms late", |it| it.late(&["delta_e", "delta_t"], 10), "P2"),
    ("another aircraft", |_| (), "P1"),
    ("rows twice", Table::duplicate, "P2"),
    ("neighbours reordered", Table::reorder, "P2"),
    ("times halved", |it| it.map(&["t"], |_, t| t / 2.0), "P2"),
];

/// A flight in steady state, and its truth: t, α.
fn flight(inputs: Inputs) -> (Table, Table) {
    let plant = Plant::P2.discrete(INTERVAL_S);
    let rng = host_sim::random::stream(3, 0);
    let start = [0.0, 0.0, 1.0, 0.02].into();
    let samples: Vec<Sample> = fly(plant, start, inputs, Noise::SENSORS, rng).take(3000).collect();
    let header = |names: &str| names.split(',').map(str::to_owned).collect();
    let time = |row: usize| format!("{:.2}", row as f64 * INTERVAL_S);
    let logged = samples.iter().enumerate().map(|(row, Sample { u, y, .. })| {
        let numbers = [u[0], u[1], y[1], y[2], y[3]].map(|it| it.to_string());
        std::iter::once(time(row)).chain(numbers).collect()
    });
    let log = Table { header: header("t,delta_e,delta_t,q,V,theta"), rows: logged.collect() };
    let true_rows =
        samples.iter().enumerate().map(|(row, it)| vec![time(row), it.x[0].to_string()]);
    (log, Table { header: header("t,alpha"), rows: true_rows.collect() })
}

/// The error of α in the second half, mrad.
fn measure(report: &Value) -> Option<f64> {
    Some(1e3 * report["accuracy"]["late_rmse"][0].as_f64()?)
}

fn replay(
    folder: &Path,
    log: &Table,
    truth: &Table,
    model: &str,
    estimator: &str,
) -> Result<Answer> {
    let (log, truth) = (log.write(folder, "log.csv")?, truth.write(folder, "truth.csv")?);
    let files = [("log", log.as_path()), ("truth", truth.as_path())];
    run(&Uav, &files, &[("model", model), ("estimator", estimator)], measure)
}

#[test]
fn an_aircraft() -> Result<()> {
    let mut cases = Vec::new();
    for estimator in ["kalman", "luenberger"] {
        let (log, truth) = flight(Inputs::Sine);
        let clean = replay(desk()?.path(), &log, &truth, "P2", estimator)?;
        for (fault, harm, model) in FAULTS {
            let (mut log, mut truth) = (log.clone(), truth.clone());
            harm(&mut log);
            if *fault == "times halved" {
                harm(&mut truth);
            }
            let faulty = replay(desk()?.path(), &log, &truth, model, estimator)?;
            cases.push(Case {
                recording: estimator.to_owned(),
                fault,
                clean: clean.clone(),
                faulty,
            });
        }
    }
    judge(&cases);
    Ok(())
}
