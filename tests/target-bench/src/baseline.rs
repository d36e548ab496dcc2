//! The recorded costs, kept in `baseline.json`, so that no change makes the estimators larger or slower unnoticed.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use crate::row::Row;

/// The relative growth of a cost that is accepted.
pub const SLACK: f64 = 0.03;

/// The rows of the table, and the compilers that they hold for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// The compiler version for each target, and whether it built `core`.
    pub compilers: BTreeMap<String, String>,
    /// The rows of the table.
    pub rows: Vec<Row>,
}

fn file() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("baseline.json")
}

impl Baseline {
    /// Reads the recorded baseline.
    ///
    /// # Errors
    /// There is none, or it is not as expected.
    pub fn kept() -> Result<Self> {
        let text = fs::read_to_string(file()).context("tests/target-bench/baseline.json")?;
        Ok(serde_json::from_str(&text)?)
    }

    /// Records this baseline.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn keep(&self) -> Result<()> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        fs::write(file(), text).context("tests/target-bench/baseline.json")
    }

    /// The rows of `measured` that grew by more than [`SLACK`], are new, or are missing: one sentence each.
    ///
    /// A target and optimisation without any measurements was left out, and is not missed; neither are peers.
    pub fn complaints(&self, measured: &[Row]) -> Vec<String> {
        let mut complaints = Vec::new();
        let now: BTreeMap<_, _> = measured.iter().map(|row| (row.key(), row)).collect();
        let kept: BTreeMap<_, _> = self.rows.iter().map(|row| (row.key(), row)).collect();
        for (key, row) in &now {
            let what = key.join(" ");
            let Some(kept) = kept.get(key) else {
                complaints.push(format!("{what} has no baseline"));
                continue;
            };
            for ((cost, before), (_, after)) in costs(kept).into_iter().zip(costs(row)) {
                if after > before * (1.0 + SLACK) {
                    complaints.push(format!("{what}: {cost} grew from {before:.0} to {after:.0}"));
                }
            }
        }
        let group = |of: &Row| (of.target.clone(), of.opt.clone(), of.is_peer());
        let groups: BTreeSet<_> = measured.iter().map(group).collect();
        let is_measured = |of: &Row| groups.contains(&group(of));
        let gone = kept.iter().filter(|(key, row)| !now.contains_key(*key) && is_measured(row));
        let gone = gone.map(|(key, _)| key);
        complaints.extend(gone.map(|key| format!("{} is not measured any more", key.join(" "))));
        complaints
    }
}

/// The costs that must not grow, by name.
fn costs(row: &Row) -> [(&'static str, f64); 8] {
    [
        ("instructions_mean", row.instructions_mean),
        ("instructions_max", row.instructions_max as f64),
        ("flash_bytes", row.flash_bytes as f64),
        ("ram_bytes", row.ram_bytes as f64),
        ("object_bytes", row.object_bytes as f64),
        ("stack_bytes", row.stack_bytes as f64),
        ("panic_symbols", row.panic_symbols as f64),
        ("double_symbols", row.double_symbols as f64),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(name: &str) -> Row {
        Row {
            name: name.into(),
            target: "here".into(),
            scalar: "f32".into(),
            opt: "3".into(),
            instructions_mean: 1000.0,
            instructions_min: 900,
            instructions_max: 1100,
            flash_bytes: 500,
            ram_bytes: 0,
            object_bytes: 100,
            stack_bytes: 64,
            panic_symbols: 0,
            double_symbols: 0,
        }
    }

    #[test]
    fn growth_is_told() {
        let baseline = Baseline { compilers: BTreeMap::new(), rows: vec![row("a"), row("b")] };
        let told = |changed: Row| baseline.complaints(&[changed, row("b")]);
        assert_eq!(told(row("a")), Vec::<String>::new());
        assert_eq!(told(Row { instructions_mean: 1030.0, ..row("a") }), Vec::<String>::new());
        assert_eq!(
            told(Row { instructions_mean: 1031.0, ..row("a") }),
            ["a f32 here 3: instructions_mean grew from 1000 to 1031"]
        );
        assert_eq!(told(Row { stack_bytes: 68, ..row("a") }).len(), 1);
        assert_eq!(told(Row { ram_bytes: 1, panic_symbols: 1, ..row("a") }).len(), 2);
        assert_eq!(told(Row { instructions_mean: 10.0, ..row("a") }), Vec::<String>::new());
    }

    #[test]
    fn rows_without_a_counterpart_are_told() {
        let baseline = Baseline { compilers: BTreeMap::new(), rows: vec![row("a")] };
        assert_eq!(
            baseline.complaints(&[row("b")]),
            ["b f32 here 3 has no baseline", "a f32 here 3 is not measured any more"]
        );
        assert_eq!(baseline.complaints(&[]), Vec::<String>::new(), "this target was left out");
        let rows = vec![row("a"), row("peer-b")];
        let baseline = Baseline { compilers: BTreeMap::new(), rows };
        assert_eq!(baseline.complaints(&[row("a")]), Vec::<String>::new(), "peers were left out");
    }
}
