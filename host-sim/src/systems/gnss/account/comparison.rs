//! The comparison of all filters on one recording.

use std::fmt;

use serde::Serialize;

use super::report::{Report, millimetres};
use crate::output;
use crate::systems::gnss::settings::Mode;

/// The report that `--filter all` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Always `gnss`.
    pub system: &'static str,
    /// Whether the receiver was assumed to move.
    pub mode: Mode,
    /// The number of epochs from the first one on.
    pub epochs: usize,
    /// The results of each filter: the object that would be reported for it alone.
    pub filters: Vec<Report>,
    /// Warnings about the files.
    pub warnings: Vec<String>,
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        let mut header = vec!["filter", "solved"];
        let known = self.filters.iter().any(|report| report.accuracy.is_some());
        let accuracy = ["final 3-D", "RMS N", "RMS E", "RMS U", "RMS 3-D", "below 10 cm after"];
        header.extend(if known { &accuracy[..] } else { &["sd N", "sd E", "sd U"] });
        header.extend(["rejected", "down-weighted", "slips"]);
        table.set_header(header);
        for report in &self.filters {
            let mut row = vec![report.title(), format!("{} of {}", report.solved, report.epochs)];
            if let Some(accuracy) = &report.accuracy {
                let [east, north, up] = accuracy.rms_enu_m.map_or([None; 3], |it| it.map(Some));
                let lengths = [Some(accuracy.final_3d_m), north, east, up, accuracy.rms_3d_m];
                row.extend(lengths.map(|length| length.map_or_else(nothing, millimetres)));
                let minutes = |minutes: f64| format!("{minutes:.1} min");
                row.push(accuracy.convergence_min.map_or_else(nothing, minutes));
            } else {
                let [east, north, up] = report.sd_enu_m;
                row.extend([north, east, up].map(millimetres));
            }
            row.extend([report.rejected, report.deweighted, report.slips].map(|it| it.to_string()));
            table.add_row(row);
        }
        table.fmt(f)
    }
}

fn nothing() -> String {
    "—".to_owned()
}
