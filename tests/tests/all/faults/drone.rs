//! Faults of a drone's receiver and its log.

use std::path::Path;

use anyhow::Result;
use host_sim::systems::drone::Drone;
use kestirim_tests::recordings::folder_of;
use rayon::prelude::*;
use serde_json::Value;

use super::table::{Table, one_in};
use super::{Answer, Case, desk, judge, run};

/// Logs, with the transmitter's position and the area that it is in.
const RECORDINGS: [[&str; 3]; 2] = [
    ["afar_1204/stops.csv", "afar_1204/truth.csv", "afar_1204/area.csv"],
    [
        "lora_20190619/lora_20190619.csv",
        "lora_20190619/lora_20190619-truth.csv",
        "lora_20190619/lora_20190619-area.csv",
    ],
];

type Fault = (&'static str, fn(&mut Table));

const LEVEL: [&str; 1] = ["rssi_db"];

const FAULTS: &[Fault] = &[
    ("levels 20 dB high", |it| it.map(&LEVEL, |_, v| v + 20.0)),
    ("levels 20 dB high from the middle on", |it| it.map_from(0.5, &LEVEL, |v| v + 20.0)),
    ("levels with the other sign", |it| it.map(&LEVEL, |_, v| -v)),
    ("levels stuck from the middle on", |it| {
        let last = it.number(it.rows.len() / 2, it.column("rssi_db"));
        it.map_from(0.5, &LEVEL, |_| last);
    }),
    ("levels all the same", |it| it.map(&LEVEL, |_, _| -70.0)),
    ("levels doubled", |it| it.map(&LEVEL, |_, v| 2.0 * v)),
    ("spikes 10 %", |it| it.map(&LEVEL, |row, v| if one_in(10, row) { v + 40.0 } else { v })),
    ("places in feet", |it| it.map(&["x", "y", "h"], |_, v| v / 0.3048)),
    ("heights in feet", |it| it.map(&["h"], |_, v| v / 0.3048)),
    ("x and y swapped", |it| it.swap("x", "y")),
    ("x mirrored", |it| it.map(&["x"], |_, v| -v)),
    ("places stuck from the middle on", |it| {
        let middle = it.rows.len() / 2;
        let at = |name: &str| it.number(middle, it.column(name));
        let (x, y) = (at("x"), at("y"));
        it.map_from(0.5, &["x"], |_| x);
        it.map_from(0.5, &["y"], |_| y);
    }),
    ("the second half lost", |it| it.rows.truncate(it.rows.len() / 2)),
    ("rows twice", Table::duplicate),
    ("neighbours reordered", Table::reorder),
    ("times halved", |it| it.map(&["t"], |_, v| v / 2.0)),
];

fn measure(report: &Value) -> Option<f64> {
    report["accuracy"]["error_m"].as_f64()
}

fn replay(log: &Table, truth: &Path, area: &Path) -> Result<Answer> {
    let desk = desk()?;
    let log = log.write(desk.path(), "log.csv")?;
    run(&Drone, &[("log", log.as_path()), ("truth", truth), ("area", area)], &[], measure)
}

#[test]
fn a_flight_over_a_transmitter() -> Result<()> {
    let Some(folder) = folder_of("drone") else { return Ok(()) };
    let mut cases = Vec::new();
    for [log, truth, area] in RECORDINGS {
        let table = Table::read(&folder.join(log))?;
        let [truth, area] = [truth, area].map(|name| folder.join(name));
        let clean = replay(&table, &truth, &area)?;
        let case = |(fault, harm): &Fault| {
            let mut table = table.clone();
            harm(&mut table);
            let faulty = replay(&table, &truth, &area)?;
            Ok(Case {
                recording: log.split_once('/').map_or(log, |(folder, _)| folder).to_owned(),
                fault,
                clean: clean.clone(),
                faulty,
            })
        };
        cases.extend(FAULTS.par_iter().map(case).collect::<Result<Vec<_>>>()?);
    }
    judge(&cases);
    Ok(())
}
