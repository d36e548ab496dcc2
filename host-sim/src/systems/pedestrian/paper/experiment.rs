//! `host-sim run pedestrian`: the paper's experiment on synthetic walks.
//!
//! Each walk is rendered to a log file in the paper's format, including its rounding, read back and tracked twice: by
//! the method of the paper and by ours. The same walks with the same sensors are logged at both rates, so that the rate
//! is the only difference.

use std::fmt;

use kestirim_replay::ScalarKind;
use kestirim_replay::pedestrian::{self, Options, walk};
use kestirim_sweep::{Block, Samples};
use serde::Serialize;

use super::published::{FIFTY_HZ, HUNDRED_HZ, PathLengths, ROUTE_M};
use crate::metrics::{mean, median, standard_deviation};
use crate::system::{RunOptions, choose_scalar};
use crate::systems::pedestrian::account::accuracy::against_footprints;
use crate::systems::pedestrian::recording::{Recording, Walked};
use crate::{Error, output};

/// The number of walks at each rate in the paper.
pub(super) const WALKS: u64 = 7;
/// The default number of repetitions of all walks, which takes a few seconds.
const DEFAULT_TRIALS: u64 = 20;
const RATES: [(u32, PathLengths); 2] = [(50, FIFTY_HZ), (100, HUNDRED_HZ)];

/// The results of the experiment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    system: &'static str,
    pub(super) seed: u64,
    pub(super) trials: u64,
    pub(super) scalar: ScalarKind,
    route_m: f64,
    pub(super) rows: Vec<Row>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Row {
    pub(super) rate_hz: u32,
    pub(super) published: PathLengths,
    pub(super) paper_method: Summary,
    pub(super) ours: Summary,
    /// The theoretical bound: none is known for this sensor and route.
    limit: Option<f64>,
}

/// Statistics of all walks at one rate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Summary {
    walks: usize,
    pub(super) mean_relative_error_percent: f64,
    worst_relative_error_percent: f64,
    /// The standard deviation of the path length (m).
    pub(super) sigma_m: f64,
    pub(super) median_rmse_m: f64,
    pub(super) median_final_error_m: f64,
    /// The length of every path (m), in the order of the walks, for the chapter.
    #[serde(skip)]
    pub(super) lengths_m: Vec<f64>,
}

/// The trials: all walks at each rate.
///
/// # Errors
/// [`Error::Usage`] for a number type that the tracker does not support.
pub fn trials(options: RunOptions) -> Result<Vec<Block>, Error> {
    let default = Options::default();
    let scalar = choose_scalar("pedestrian", options.scalar, &ScalarKind::ALL, default.scalar)?;
    let methods = [Options { scalar, ..Options::published() }, Options { scalar, ..default }];
    let walks = options.trials.unwrap_or(DEFAULT_TRIALS).saturating_mul(WALKS);
    let block = |(rate_hz, _): (u32, PathLengths)| {
        let columns = ["published", "ours"]
            .map(|method| ["path", "rmse", "end off"].map(|it| format!("{method} {it}_m")));
        let walk = move |index| {
            let tracked = track(options.seed, index, f64::from(rate_hz), &methods);
            tracked.map(|rows| rows.concat()).map_err(|error| error.to_string())
        };
        Block::new(format!("{rate_hz} Hz"), columns.into_iter().flatten(), walks, walk)
    };
    Ok(RATES.map(block).into())
}

/// Evaluates the samples of the trials; the same options give the same report with any number of threads.
///
/// # Errors
/// Those of [`trials`].
pub fn report(options: RunOptions, samples: &[Samples]) -> Result<Report, Error> {
    let default = Options::default().scalar;
    let scalar = choose_scalar("pedestrian", options.scalar, &ScalarKind::ALL, default)?;
    let row = |((rate_hz, published), walks): ((u32, PathLengths), &Samples)| {
        let [paper_method, ours] = [0, 3].map(|first| Summary::of(walks, first));
        Row { rate_hz, published, paper_method, ours, limit: None }
    };
    Ok(Report {
        system: "pedestrian",
        seed: options.seed,
        trials: samples[0].len() as u64 / WALKS,
        scalar,
        route_m: ROUTE_M,
        rows: RATES.into_iter().zip(samples).map(row).collect(),
    })
}

/// Generates and logs a walk, and tracks the log by each method: the length of the path, its RMSE, and the error at its
/// end (m).
fn track(
    seed: u64,
    index: u64,
    rate_hz: f64,
    methods: &[Options; 2],
) -> Result<[[f64; 3]; 2], Error> {
    let recording = Recording::synthetic(Walked::Route, rate_hz, seed, index)?;
    let outcome = |options| -> Result<_, Error> {
        let walk = walk(&recording.log.samples, options).map_err(|error| refused(index, &error))?;
        let accuracy = against_footprints(&walk, &recording.footprints);
        Ok([walk.path_length_m, accuracy.rmse_m, accuracy.final_error_m])
    };
    let [paper, ours] = methods;
    Ok([outcome(paper)?, outcome(ours)?])
}

/// The error that the tracker refuses a synthetic walk.
pub(super) fn refused(index: u64, error: &pedestrian::Error) -> Error {
    Error::Usage(format!("synthetic walk {index}: {error}"))
}

impl Summary {
    /// The statistics of a method from its three columns.
    fn of(walks: &Samples, first: usize) -> Self {
        let lengths_m = walks.column(first);
        let errors: Vec<_> = lengths_m.iter().copied().map(error_percent).collect();
        Self {
            walks: lengths_m.len(),
            mean_relative_error_percent: mean(&errors),
            worst_relative_error_percent: errors.iter().copied().fold(0.0, f64::max),
            sigma_m: standard_deviation(&lengths_m),
            median_rmse_m: median(&walks.column(first + 1)),
            median_final_error_m: median(&walks.column(first + 2)),
            lengths_m,
        }
    }
}

/// The absolute error of a path's length on the route (%).
pub(super) fn error_percent(length_m: f64) -> f64 {
    100.0 * (length_m / ROUTE_M - 1.0).abs()
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, trials, route_m, .. } = self;
        writeln!(
            f,
            "pedestrian: error of the path length on a route of {route_m:.2} m\n\
             {trials} × {WALKS} synthetic walks, seed {seed}"
        )?;
        let cell = |error: f64, sigma_m: f64| format!("{error:.2} %, σ {:.1} cm", 100.0 * sigma_m);
        let tracked = |summary: &Summary| {
            let error = cell(summary.mean_relative_error_percent, summary.sigma_m);
            format!("{error}\nend off by {:.2} m", summary.median_final_error_m)
        };
        let mut table = output::table();
        table.set_header(["rate", "published", "paper's method", "ours", "limit"]);
        for row in &self.rows {
            let published = row.published;
            table.add_row([
                format!("{} Hz", row.rate_hz),
                cell(published.mean_relative_error_percent, published.sigma_m),
                tracked(&row.paper_method),
                tracked(&row.ours),
                row.limit.map_or_else(|| "—".to_owned(), |limit| format!("{limit:.2} %")),
            ]);
        }
        table.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Settings, experiment};
    use crate::systems::pedestrian::Pedestrian;

    #[test]
    fn the_same_seed_gives_the_same_report_at_any_number_of_threads() {
        let options = RunOptions { trials: Some(1), seed: 3, scalar: None };
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let run = |options| experiment::<Pedestrian>(&options, &Settings::new([])).unwrap();
        let report = run(options);
        assert_eq!(report, alone.install(|| run(options)));
        assert_ne!(report, run(RunOptions { seed: 4, ..options }));
    }
}
