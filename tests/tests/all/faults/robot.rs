//! Faults of radios, anchors and the lists of them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::Result;
use host_sim::systems::robot::Robot;
use kestirim_tests::recordings::folder_of;
use rayon::prelude::*;
use serde_json::Value;

use super::table::{Table, one_in};
use super::{Answer, Case, desk, judge, run};

/// Recordings in a plane, with the known height of the tag, m.
const RECORDINGS: [(&str, &str); 3] =
    [("esp32_los2", "0.1"), ("lias_mid_tag1", ""), ("trek_m1l", "")];

/// Anchors and ranges.
struct Room {
    anchors: Table,
    ranges: Table,
    height: f64,
}

type Fault = (&'static str, fn(&mut Room));

impl Room {
    /// Changes the ranges of one anchor, or of all.
    fn ranges(&mut self, anchor: Option<usize>, mut with: impl FnMut(usize, f64) -> f64) {
        let name = anchor.map(|anchor| self.anchors.rows[anchor][0].clone());
        let column = self.ranges.column("anchor");
        let names: Vec<_> = self.ranges.rows.iter().map(|row| row[column].clone()).collect();
        self.ranges.map(&["range"], |row, range| {
            if name.as_ref().is_none_or(|name| *name == names[row]) {
                with(row, range)
            } else {
                range
            }
        });
    }

    fn swap_anchors(&mut self) {
        let [first, second] = [1, 2].map(|row| self.anchors.rows[row][0].clone());
        (self.anchors.rows[1][0], self.anchors.rows[2][0]) = (second, first);
    }

    fn stick(&mut self) {
        let from = self.ranges.rows.len() / 2;
        let mut last = None;
        self.ranges(
            Some(1),
            |row, range| if row < from { range } else { *last.get_or_insert(range) },
        );
    }

    fn stick_all(&mut self) {
        let from = self.ranges.rows.len() / 2;
        let column = self.ranges.column("anchor");
        let names: Vec<_> = self.ranges.rows.iter().map(|row| row[column].clone()).collect();
        let mut last = BTreeMap::new();
        self.ranges.map(&["range"], |row, range| {
            if row < from { range } else { *last.entry(names[row].clone()).or_insert(range) }
        });
    }

    fn lose(&mut self, anchor: usize) {
        let name = self.anchors.rows[anchor][0].clone();
        let column = self.ranges.column("anchor");
        self.ranges.rows.retain(|row| row[column] != name);
    }

    /// Moves the second anchor by a metre away from the middle of all: its ranges are too short there.
    fn push_out(&mut self) {
        let count = self.anchors.rows.len();
        let axes = ["x", "y"].map(|name| self.anchors.column(name));
        let [dx, dy] = axes.map(|column| {
            let all = (0..count).map(|row| self.anchors.number(row, column));
            self.anchors.number(1, column) - all.sum::<f64>() / count as f64
        });
        let far = dx.hypot(dy);
        self.anchors.map(&["x"], |row, x| if row == 1 { x + dx / far } else { x });
        self.anchors.map(&["y"], |row, y| if row == 1 { y + dy / far } else { y });
    }

    /// Keeps only the ranges of the last two anchors.
    fn keep_two(&mut self) {
        let (anchors, from) = (self.anchors.rows.len(), self.ranges.rows.len() / 3);
        let lost: Vec<_> =
            self.anchors.rows[..anchors - 2].iter().map(|row| row[0].clone()).collect();
        let column = self.ranges.column("anchor");
        let rest = self.ranges.rows.split_off(from);
        self.ranges.rows.extend(rest.into_iter().filter(|row| !lost.contains(&row[column])));
    }
}

const FAULTS: &[Fault] = &[
    ("two anchors swapped", Room::swap_anchors),
    ("an anchor moved by 2 m", |it| {
        it.anchors.map(&["x"], |row, x| if row == 1 { x + 2.0 } else { x });
    }),
    ("an anchor 1 m too far out", Room::push_out),
    ("an anchor moved by 0.5 m", |it| {
        it.anchors.map(&["y"], |row, y| if row == 0 { y + 0.5 } else { y });
    }),
    ("anchors in feet", |it| it.anchors.map(&["x", "y", "z"], |_, v| v / 0.3048)),
    ("ranges in feet", |it| it.ranges(None, |_, v| v / 0.3048)),
    ("ranges 10 % long", |it| it.ranges(None, |_, v| v * 1.1)),
    ("the height 1 m wrong", |it| it.height += 1.0),
    ("ranges cut at 3 m", |it| it.ranges(None, |_, v| v.min(3.0))),
    ("an anchor stuck from the middle on", Room::stick),
    ("an anchor 2 m long from the middle on", |it| {
        let from = it.ranges.rows.len() / 2;
        it.ranges(Some(1), |row, v| if row < from { v } else { v + 2.0 });
    }),
    ("an anchor never heard", |it| it.lose(0)),
    ("two anchors heard from a third of the log on", Room::keep_two),
    ("dropout 1 s", |it| it.ranges.drop_out(1.0)),
    ("dropout 10 s", |it| it.ranges.drop_out(10.0)),
    ("spikes 1 %", |it| it.ranges(None, |row, v| if one_in(100, row) { v + 40.0 } else { v })),
    ("spikes 10 %", |it| it.ranges(None, |row, v| if one_in(10, row) { v + 5.0 } else { v })),
    ("spikes 30 %", |it| it.ranges(None, |row, v| if one_in(3, row) { v + 5.0 } else { v })),
    ("rows twice", |it| it.ranges.duplicate()),
    ("neighbours reordered", |it| it.ranges.reorder()),
    ("all ranges 1 m long", |it| it.ranges(None, |_, v| v + 1.0)),
    ("all ranges doubled", |it| it.ranges(None, |_, v| 2.0 * v)),
    ("all ranges halved", |it| it.ranges(None, |_, v| v / 2.0)),
    ("all ranges stuck from the middle on", Room::stick_all),
    ("anchors counted from another number", |it| {
        let mut names: Vec<_> = it.anchors.rows.iter().map(|row| row[0].clone()).collect();
        names.rotate_left(1);
        for (row, name) in it.anchors.rows.iter_mut().zip(names) {
            row[0] = name;
        }
    }),
    ("all ranges negative", |it| it.ranges(None, |_, v| -v)),
    ("room mirrored", |it| it.anchors.map(&["x"], |_, x| -x)),
];

fn measure(report: &Value) -> Option<f64> {
    report["accuracy"]["rmse_m"].as_f64()
}

fn replay(room: &Room, truth: &Path) -> Result<Answer> {
    let desk = desk()?;
    let anchors = room.anchors.write(desk.path(), "anchors.csv")?;
    let ranges = room.ranges.write(desk.path(), "ranges.csv")?;
    let files = [("anchors", anchors.as_path()), ("log", ranges.as_path()), ("truth", truth)];
    run(&Robot, &files, &[("height", &room.height.to_string())], measure)
}

fn height(truth: &Path) -> Result<f64> {
    let truth = Table::read(truth)?;
    let z = truth.column("z");
    Ok((0..truth.rows.len()).map(|row| truth.number(row, z)).sum::<f64>() / truth.rows.len() as f64)
}

#[test]
fn a_tag() -> Result<()> {
    let Some(folder) = folder_of("robot") else { return Ok(()) };
    let mut cases = Vec::new();
    for (recording, known) in RECORDINGS {
        let file = |name: &str| -> PathBuf { folder.join(recording).join(name) };
        let truth = file("truth.csv");
        let height = known.parse().or_else(|_| height(&truth))?;
        let room = || -> Result<Room> {
            let (anchors, ranges) =
                (Table::read(&file("anchors.csv"))?, Table::read(&file("ranges.csv"))?);
            Ok(Room { anchors, ranges, height })
        };
        let clean = replay(&room()?, &truth)?;
        let case = |(fault, harm): &Fault| {
            let mut room = room()?;
            harm(&mut room);
            let faulty = replay(&room, &truth)?;
            Ok(Case { recording: recording.to_owned(), fault, clean: clean.clone(), faulty })
        };
        cases.extend(FAULTS.par_iter().map(case).collect::<Result<Vec<_>>>()?);
    }
    judge(&cases);
    Ok(())
}
