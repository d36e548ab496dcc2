//! What a replay reports.

use std::fmt;

use serde::Serialize;

use super::model::STATE_COLUMNS;
use super::options::EstimatorKind;
use crate::output;

/// What the command prints. Units rad, rad/s, m/s, rad.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Always `uav`.
    pub system: &'static str,
    /// Which estimator.
    pub estimator: EstimatorKind,
    /// Lines of the log.
    pub samples: usize,
    /// The usual time between them, s.
    pub interval_s: f64,
    /// How many times lines are missing.
    pub gaps: usize,
    /// Empty fields.
    pub missing: usize,
    /// What measurements said beyond what was expected.
    pub innovations: Vec<Residual>,
    /// α, q, V, θ after the last line.
    pub estimate: [f64; 4],
    /// What a reader should know.
    pub warnings: Vec<String>,
    /// How far from the truth, if it is known.
    pub accuracy: Option<Accuracy>,
}

/// Of one output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Residual {
    /// Its column.
    pub output: String,
    /// How many times it was measured.
    pub measured: usize,
    /// Root mean square of measured less expected.
    pub rms: f64,
}

/// How good the estimates are.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// Lines whose time is one of the truth's.
    pub samples: usize,
    /// Root mean square errors of α, q, V, θ, where their truth is known.
    pub rmse: [Option<f64>; 4],
    /// The same over the second half of the log.
    pub late_rmse: [Option<f64>; 4],
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        let mut row = |name: &str, value: String| {
            table.add_row([name, value.as_str()]);
        };
        row("lines", format!("{} at intervals of {} s", self.samples, self.interval_s));
        row("gaps", self.gaps.to_string());
        row("not measured", self.missing.to_string());
        for (name, value) in STATE_COLUMNS.iter().zip(self.estimate) {
            row(&format!("last {name}"), format!("{value:.4}"));
        }
        for Residual { output, rms, .. } in &self.innovations {
            row(&format!("innovations of {output}"), format!("{rms:.2e}"));
        }
        if let Some(accuracy) = &self.accuracy {
            let errors = accuracy.rmse.iter().zip(accuracy.late_rmse);
            for (name, errors) in STATE_COLUMNS.iter().zip(errors) {
                if let (Some(all), Some(late)) = errors {
                    row(&format!("RMSE of {name}"), format!("{all:.2e}, second half {late:.2e}"));
                }
            }
        }
        table.fmt(f)
    }
}
