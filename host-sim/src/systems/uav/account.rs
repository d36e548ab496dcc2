//! The results of a flight.

pub mod accuracy;
pub mod states;

use std::collections::BTreeMap;

use kestirim_replay::uav::{Estimate, EstimatorKind, STATE_COLUMNS};
use serde::Serialize;

use self::accuracy::Accuracy;
use super::Uav;
use super::recording::Recording;
use super::track::Track;
use crate::Error;
use crate::metrics::rms;
use crate::system::{Account, Health, Reason, System, Table};
use crate::table::Found;

/// The report that a replay prints, in rad, rad/s, m/s and rad.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Report {
    /// Always `uav`.
    system: &'static str,
    /// The estimator.
    estimator: EstimatorKind,
    /// The number of lines of the log.
    samples: usize,
    /// The usual time between lines (s).
    interval_s: f64,
    /// The number of gaps in the log.
    gaps: usize,
    /// The number of empty fields.
    missing: usize,
    /// The innovations of each output.
    innovations: Vec<Residual>,
    /// α, q, V, θ after the last line.
    estimate: [f64; 4],
    /// The further estimated states at the end: value and standard deviation, in SI units.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    beside: BTreeMap<String, [f64; 2]>,
    /// The standard deviations of the gusts along and across that the innovations support most (m/s).
    #[serde(skip_serializing_if = "Option::is_none")]
    gust: Option<[f64; 2]>,
    /// The conclusions about the format of the log.
    import: Vec<String>,
    /// Warnings for the user.
    warnings: Vec<String>,
    /// The accuracy, if the truth is known.
    accuracy: Option<Accuracy>,
}

/// Statistics of the innovations of one output.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Residual {
    /// The column of the output.
    output: String,
    /// The number of measurements.
    measured: usize,
    /// The root mean square innovation (measured minus expected).
    rms: f64,
    /// The number of measurements that contradicted the estimate and were rejected.
    rejected: u32,
}

impl Residual {
    /// The warning about rejected measurements, if there are many.
    fn warning(&self) -> Option<String> {
        let share = f64::from(self.rejected) / self.measured.max(1) as f64;
        (share > REJECTED).then(|| {
            format!(
                "{:.0} % of the measurements of {} contradict the estimate and were left out: a wrong model or unit, or \
                 a broken sensor",
                100.0 * share,
                self.output
            )
        })
    }
}

/// The share of an output's measurements from which on their rejection is reported.
const REJECTED: f64 = 0.1;

/// Evaluates a flight tracked by this estimator.
pub(super) fn account(
    recording: &Recording,
    estimator: EstimatorKind,
    track: &Track,
) -> Result<Account, Error> {
    let Track { flight, followed, .. } = track;
    let accuracy = Accuracy::of(track);
    let found = match recording {
        Recording::Logged(logged) => logged.found.clone(),
        Recording::Synthetic(_) => Found::default(),
    };
    let mut warnings = [found.warnings, track.warnings.clone()].concat();
    if accuracy.as_ref().is_some_and(|accuracy| accuracy.samples == 0) {
        warnings.push("no time of the truth is one of the log's".to_owned());
    }
    let last = followed.estimates.last();
    let last = last.map(|estimate| flight.absolute(estimate)).unwrap_or_default();
    let missing = flight.log.samples.iter().flat_map(|sample| &sample.measured);
    let residuals = followed.innovations.iter().zip(followed.rejected.iter());
    let innovations = flight.names().zip(residuals).map(|(output, (innovations, &rejected))| {
        let innovations: Vec<f64> = innovations.iter().copied().flatten().collect();
        let (output, measured) = (output.to_owned(), innovations.len());
        Residual { output, measured, rms: rms(&innovations), rejected }
    });
    let innovations: Vec<_> = innovations.collect();
    warnings.extend(innovations.iter().filter_map(Residual::warning));
    let report = Report {
        system: Uav::NAME,
        estimator,
        samples: flight.log.samples.len(),
        interval_s: flight.log.interval_s,
        gaps: flight.log.gaps,
        missing: missing.filter(|measured| measured.is_none()).count(),
        innovations,
        estimate: last.into(),
        beside: followed.beside.iter().map(|it| (it.name.clone(), [it.value, it.sigma])).collect(),
        gust: followed.gust,
        import: found.import,
        warnings,
        accuracy,
    };
    let mut account = Account::new(&report, report.warnings.clone())?;
    account.understood(&report.import);
    for (reason, sentence) in followed.doubted_lines() {
        account.warn(sentence);
        account.doubt(reason);
    }
    if let Recording::Logged(logged) = recording {
        for contradiction in followed.contradictions() {
            account.warn(contradiction.sentence(flight.names()));
            account.doubt(Reason::Innovations);
        }
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
        for Residual { output, rms, rejected, .. } in &self.innovations {
            let left_out =
                if *rejected > 0 { format!(", {rejected} left out") } else { String::new() };
            account.fact(format!("innovations of {output}"), format!("{rms:.2e}{left_out}"));
        }
        for (name, [value, sigma]) in &self.beside {
            account.fact(name, format!("{value:.4} ± {sigma:.4}"));
        }
        if let Some([along, across]) = self.gust {
            account.fact(
                "gusts, as the innovations say",
                format!("{along:.2} m/s along, {across:.2} across"),
            );
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

/// The table of time, states and, for a filter, their standard deviations on every line. Contradictions between model
/// and log apply to every row.
pub(super) fn table(recording: &Recording, Track { flight, followed, .. }: &Track) -> Table {
    let row = |estimate: &Estimate| {
        let state = flight.absolute(estimate);
        let time = format!("{:.6}", estimate.t_us as f64 / 1e6);
        let number = |number: f64| format!("{number:.9}");
        let sigma = (0..4).map(|i| estimate.sigma.map_or_else(String::new, |it| number(it[i])));
        std::iter::once(time).chain(state.iter().copied().map(number)).chain(sigma).collect()
    };
    let health = match recording {
        Recording::Logged(_) => followed.lines().map(Health::state).collect(),
        Recording::Synthetic(_) => followed.healths.iter().copied().map(Health::state).collect(),
    };
    let mut table = Table::new(&["t"]);
    table.header.extend(STATE_COLUMNS.map(str::to_owned));
    table.header.extend(STATE_COLUMNS.map(|name| format!("s_{name}")));
    Table { rows: followed.estimates.iter().map(row).collect(), health, ..table }
}
