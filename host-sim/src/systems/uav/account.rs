//! What came of a flight.

pub mod accuracy;
pub mod states;

use serde::Serialize;

use self::accuracy::Accuracy;
use super::recording::Recording;
use super::recording::model::STATE_COLUMNS;
use super::settings::EstimatorKind;
use super::track::Track;
use super::track::estimators::Estimate;
use crate::Error;
use crate::metrics::rms;
use crate::system::{Account, Table};

/// What a replay prints. Units rad, rad/s, m/s, rad.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Report {
    /// Always `uav`.
    system: &'static str,
    /// Which estimator.
    estimator: EstimatorKind,
    /// Lines of the log.
    samples: usize,
    /// The usual time between them, s.
    interval_s: f64,
    /// How many times lines are missing.
    gaps: usize,
    /// Empty fields.
    missing: usize,
    /// What measurements said beyond what was expected.
    innovations: Vec<Residual>,
    /// α, q, V, θ after the last line.
    estimate: [f64; 4],
    /// What a reader should know.
    warnings: Vec<String>,
    /// How far from the truth, if it is known.
    accuracy: Option<Accuracy>,
}

/// Of one output.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Residual {
    /// Its column.
    output: String,
    /// How many times it was measured.
    measured: usize,
    /// Root mean square of measured less expected.
    rms: f64,
}

/// What came of a flight by this estimator.
pub(super) fn account(
    recording: &Recording,
    estimator: EstimatorKind,
    track: &Track,
) -> Result<Account, Error> {
    let Track { flight, followed } = track;
    let accuracy = Accuracy::of(track);
    let mut warnings = flight.warnings();
    if accuracy.as_ref().is_some_and(|accuracy| accuracy.samples == 0) {
        warnings.push("no time of the truth is one of the log's".to_owned());
    }
    let last = followed.estimates.last();
    let last = last.map(|estimate| flight.absolute(estimate)).unwrap_or_default();
    let missing = flight.log.samples.iter().flat_map(|sample| &sample.measured);
    let innovations = flight.names().zip(&followed.innovations).map(|(output, innovations)| {
        Residual { output: output.to_owned(), measured: innovations.len(), rms: rms(innovations) }
    });
    let report = Report {
        system: "uav",
        estimator,
        samples: flight.log.samples.len(),
        interval_s: flight.log.interval_s,
        gaps: flight.log.gaps,
        missing: missing.filter(|measured| measured.is_none()).count(),
        innovations: innovations.collect(),
        estimate: last.into(),
        warnings,
        accuracy,
    };
    let mut account = Account::new(&report, report.warnings.clone())?;
    if let Recording::Logged(logged) = recording {
        account.about = Some(logged.path.clone());
    }
    report.tell(&mut account);
    Ok(account)
}

impl Report {
    fn tell(&self, account: &mut Account) {
        account.fact("lines", format!("{} at intervals of {} s", self.samples, self.interval_s));
        account.fact("gaps", self.gaps.to_string());
        account.fact("not measured", self.missing.to_string());
        for (name, value) in STATE_COLUMNS.iter().zip(self.estimate) {
            account.fact(format!("last {name}"), format!("{value:.4}"));
        }
        for Residual { output, rms, .. } in &self.innovations {
            account.fact(format!("innovations of {output}"), format!("{rms:.2e}"));
        }
        let Some(accuracy) = &self.accuracy else { return };
        let errors = accuracy.rmse.iter().zip(accuracy.late_rmse);
        for (name, errors) in STATE_COLUMNS.iter().zip(errors) {
            if let (Some(all), Some(late)) = errors {
                let value = format!("{all:.2e}, second half {late:.2e}");
                account.fact(format!("RMSE of {name}"), value);
            }
        }
    }
}

/// Time and states of every line.
pub(super) fn table(Track { flight, followed }: &Track) -> Table {
    let row = |estimate: &Estimate| {
        let state = flight.absolute(estimate);
        let time = format!("{:.6}", estimate.t_us as f64 / 1e6);
        std::iter::once(time).chain(state.iter().map(|number| format!("{number:.9}"))).collect()
    };
    let mut table = Table::new(&["t"]);
    table.header.extend(STATE_COLUMNS.map(str::to_owned));
    Table { rows: followed.estimates.iter().map(row).collect(), ..table }
}
