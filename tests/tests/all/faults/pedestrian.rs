//! Faults of a foot's IMU.

use std::path::Path;

use anyhow::Result;
use host_sim::systems::pedestrian::Pedestrian;
use kestirim_tests::recordings;
use rayon::prelude::*;
use serde_json::Value;

use super::table::{Table, one_in};
use super::{Answer, Case, desk, judge, run};

const FORCE: [&str; 3] = ["ax", "ay", "az"];
const RATE: [&str; 3] = ["gx", "gy", "gz"];
const ALL: [&str; 6] = ["ax", "ay", "az", "gx", "gy", "gz"];

/// A fault of the log, and its effect on times.
type Fault = (&'static str, fn(&mut Table), fn(f64, f64) -> f64);

fn same(t: f64, _: f64) -> f64 {
    t
}

/// Repeats the same sample for `length` seconds after the middle.
fn stick(table: &mut Table, length: f64) {
    let is_stuck = table.after_the_middle(length);
    for row in 1..table.rows.len() {
        if is_stuck(table, row) {
            for name in ALL {
                let column = table.column(name);
                let before = table.rows[row - 1][column].clone();
                table.rows[row][column] = before;
            }
        }
    }
}

fn zero(table: &mut Table, length: f64) {
    let is_zero = table.after_the_middle(length);
    for row in 0..table.rows.len() {
        if is_zero(table, row) {
            for name in ALL {
                let column = table.column(name);
                "0".clone_into(&mut table.rows[row][column]);
            }
        }
    }
}

fn clip(table: &mut Table, columns: &[&str]) {
    let end = table.largest(columns) / 2.0;
    table.map(columns, |_, value| value.clamp(-end, end));
}

fn spikes(table: &mut Table, many: usize) {
    table.map(&FORCE, |row, value| if one_in(many, row) { 150.0 } else { value });
    table.map(&RATE, |row, value| if one_in(many, row) { -30.0 } else { value });
}

const FAULTS: &[Fault] = &[
    ("zeros 0.1 s", |it| zero(it, 0.1), same),
    ("zeros 0.6 s", |it| zero(it, 0.6), same),
    ("zeros 10 s", |it| zero(it, 10.0), same),
    ("dropout 0.2 s", |it| it.drop_out(0.2), same),
    ("dropout 1 s", |it| it.drop_out(1.0), same),
    ("dropout 10 s", |it| it.drop_out(10.0), same),
    ("stuck 0.2 s", |it| stick(it, 0.2), same),
    ("stuck 2 s", |it| stick(it, 2.0), same),
    ("stuck 10 s", |it| stick(it, 10.0), same),
    ("spikes 0.2 %", |it| spikes(it, 500), same),
    ("spikes 1 %", |it| spikes(it, 100), same),
    ("spikes 10 %", |it| spikes(it, 10), same),
    (
        "acceleration 0.5 m/s² off from the middle on",
        |it| it.map_from(0.5, &["ax"], |v| v + 0.5),
        same,
    ),
    ("rate 3 °/s off from the middle on", |it| it.map_from(0.5, &["gz"], |v| v + 0.05), same),
    ("acceleration cut at half", |it| clip(it, &FORCE), same),
    ("rates cut at half", |it| clip(it, &RATE), same),
    ("rows twice", Table::duplicate, same),
    ("neighbours reordered", Table::reorder, same),
    ("times halved", |it| it.map(&["t"], |_, t| t / 2.0), |t, _| t / 2.0),
    ("times doubled", |it| it.map(&["t"], |_, t| t * 2.0), |t, _| t * 2.0),
    (
        "clock jumps 5 s ahead",
        |it| it.map_from(0.5, &["t"], |t| t + 5.0),
        |t, middle| if t < middle { t } else { t + 5.0 },
    ),
    (
        "clock jumps 5 s back",
        |it| it.map_from(0.5, &["t"], |t| t - 5.0),
        |t, middle| if t < middle { t } else { t - 5.0 },
    ),
    ("clock 5 % fast", |it| it.map(&["t"], |_, t| t * 1.05), |t, _| t * 1.05),
    ("x and y of the rate swapped", |it| it.swap("gx", "gy"), same),
    ("z of the rate mirrored", |it| it.map(&["gz"], |_, v| -v), same),
    ("x of the rate dead", |it| it.map(&["gx"], |_, _| 0.0), same),
    ("acceleration in g under m/s²", |it| it.map(&FORCE, |_, v| v / 9.80665), same),
    ("rates in °/s under rad/s", |it| it.map(&RATE, |_, v| v.to_degrees()), same),
    ("acceleration 5 % large", |it| it.map(&FORCE, |_, v| v * 1.05), same),
    ("rates 5 % large", |it| it.map(&RATE, |_, v| v * 1.05), same),
    ("rates 20 % large", |it| it.map(&RATE, |_, v| v * 1.2), same),
    ("rates 50 ms late", |it| it.late(&RATE, 10), same),
];

fn measure(report: &Value) -> Option<f64> {
    report["accuracy"]["rmse_m"].as_f64()
}

fn replay(folder: &Path, log: &Table, truth: &Table) -> Result<Answer> {
    let (log, truth) = (log.write(folder, "log.csv")?, truth.write(folder, "truth.csv")?);
    let files = [("log", log.as_path()), ("truth", truth.as_path())];
    run(&Pedestrian, &files, &[("sensor", "industrial")], measure)
}

#[test]
fn a_foot() -> Result<()> {
    let Some(folder) = recordings::folder() else { return Ok(()) };
    let mut cases = Vec::new();
    for (log, truth) in recordings::gcp(&folder, &[36, 57]) {
        let recording = log.file_stem().unwrap_or_default().display().to_string();
        let (log, truth) = (Table::read(&log)?, Table::read(&truth)?);
        let clean = replay(desk()?.path(), &log, &truth)?;
        let [from, to] = log.span();
        let case = |(fault, harm, time): &Fault| {
            let (mut log, mut truth) = (log.clone(), truth.clone());
            harm(&mut log);
            truth.map(&["t"], |_, t| time(t, f64::midpoint(from, to)));
            let faulty = replay(desk()?.path(), &log, &truth)?;
            Ok(Case { recording: recording.clone(), fault, clean: clean.clone(), faulty })
        };
        cases.extend(FAULTS.par_iter().map(case).collect::<Result<Vec<_>>>()?);
    }
    judge(&cases);
    Ok(())
}
