//! What came of a walk.

pub mod accuracy;
pub(crate) mod warning;

use serde::Serialize;

use self::accuracy::Accuracy;
use super::Pedestrian;
use super::recording::Recording;
use super::recording::position::TrackPoint;
use super::track::Walk;
use crate::Error;
use crate::system::{Account, System, Table};

/// What a replay prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    samples: usize,
    duration_s: f64,
    path_length_m: f64,
    closure_m: f64,
    strides: Vec<StrideReport>,
    import: Vec<String>,
    warnings: Vec<String>,
    accuracy: Option<Accuracy>,
}

#[derive(Debug, Clone, Serialize)]
struct StrideReport {
    t: f64,
    x: f64,
    y: f64,
    z: f64,
    length_m: f64,
}

/// What came of a walk.
pub(super) fn account(recording: &Recording, walk: &Walk) -> Result<Account, Error> {
    let log = &recording.log;
    let strides = walk.strides.iter().map(|stride| {
        let [x, y, z] = stride.position;
        StrideReport { t: stride.time_us as f64 / 1e6, x, y, z, length_m: stride.length_m }
    });
    let accuracy = Accuracy::of(recording, walk);
    let report = Report {
        system: Pedestrian::NAME,
        samples: log.samples.len(),
        duration_s: log.duration_s(),
        path_length_m: walk.path_length_m,
        closure_m: walk.closure_m,
        strides: strides.collect(),
        import: log.import.clone(),
        warnings: log.warnings.iter().chain(&walk.warnings).cloned().collect(),
        accuracy,
    };
    let mut account = Account::new(&report, report.warnings.clone())?;
    account.about = Some(recording.path.clone());
    account.understood(&report.import);
    for reason in &walk.reasons {
        account.doubt(*reason);
    }
    account.fact("samples", format!("{} in {:.1} s", report.samples, report.duration_s));
    account.fact("strides", report.strides.len().to_string());
    account.fact("path length", format!("{:.2} m", report.path_length_m));
    account.fact("start to end", format!("{:.2} m", report.closure_m));
    for (name, value) in accuracy.iter().flat_map(Accuracy::in_words) {
        account.fact(name, value);
    }
    Ok(account)
}

/// Time and position of every sample.
pub(super) fn table(walk: &Walk) -> Table {
    let row = |point: &TrackPoint| {
        let time = format!("{}.{:06}", point.time_us / 1_000_000, point.time_us % 1_000_000);
        let [x, y, z] = point.position.map(|metres| format!("{metres:.6}"));
        vec![time, x, y, z]
    };
    Table { rows: walk.track.iter().map(row).collect(), ..Table::new(&["t", "x", "y", "z"]) }
}
