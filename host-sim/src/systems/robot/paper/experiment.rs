//! `host-sim run robot`: the paper's Table 1, showing the effect of the filters' start.
//!
//! Every filter of the paper is run twice: started at the surveyed point, which is the only way to obtain its numbers,
//! and started at the first trilateration, as is necessary if the robot's position is not yet known.

use std::fmt;

use kestirim_replay::ScalarKind;
use kestirim_sweep::{Block, Samples};
use serde::Serialize;

use super::limit::{Knowledge, mean_error_limit};
use super::published::{PositionErrors, TABLE_1, TABLE_1_MEAN};
use crate::metrics::mean;
use crate::system::{RunOptions, System, choose_scalar};
use crate::systems::robot::Robot;
use crate::systems::robot::simulate::day::{COLUMNS, Day, LINES, WAYS};
use crate::systems::robot::simulate::scenario;
use crate::{Error, output};

/// The default number of repetitions, with which the table's mean is accurate to a fiftieth.
const TRIALS: u64 = 200;

/// Errors of the mean of 50 positions (cm).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Row {
    /// The errors as published.
    pub published: PositionErrors,
    /// The errors by the paper's protocol, its filters started at the surveyed point.
    pub from_the_truth: PositionErrors,
    /// The errors of the paper's filters started at the first trilateration.
    pub honest_start: PositionErrors,
    /// The error of the paper's adaptive filter started 10 cm from the surveyed point.
    pub aekf_from_10_cm_beside_cm: f64,
    /// The error of this library's default without calibration.
    pub ours_cm: f64,
    /// The error of this library's default with the anchors calibrated at six marked points.
    pub ours_calibrated_cm: f64,
    /// The error of the best unbiased estimator if nothing is known about the biases.
    pub limit_cm: f64,
    /// The error of the best unbiased estimator if each anchor's bias is known.
    pub limit_calibrated_cm: f64,
}

/// Root mean square errors along the straight line (cm).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Line {
    /// The error of trilateration alone.
    pub unfiltered_cm: f64,
    /// The error of the paper's EKF, started at the first trilateration.
    pub ekf_cm: f64,
    /// The error of the paper's adaptive EKF, started at the first trilateration.
    pub aekf_cm: f64,
    /// The error of this library's default without calibration.
    pub ours_cm: f64,
    /// The error of this library's default with the anchors calibrated.
    pub ours_calibrated_cm: f64,
}

/// The report that the command prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    system: &'static str,
    pub(super) seed: u64,
    pub(super) trials: usize,
    pub(super) scalar: ScalarKind,
    pub(super) points: Vec<Row>,
    pub(super) mean: Row,
    pub(super) line: Line,
}

/// The trials: one per day.
///
/// # Errors
/// If the number type is not supported.
pub fn trials(options: RunOptions) -> Result<Vec<Block>, Error> {
    let scalar = choose_scalar(Robot::NAME, options.scalar, &ScalarKind::ALL, ScalarKind::F32)?;
    let points = (1..=15).flat_map(|point| WAYS.map(|way| format!("P{point} {way}_cm")));
    let columns: Vec<_> = points.chain(LINES.map(|way| format!("line {way}_cm"))).collect();
    let day = move |trial| {
        let day = Day::run(options.seed, trial, scalar).map_err(|error| error.to_string())?;
        Ok([day.points.as_flattened(), &day.line].concat())
    };
    Ok(vec![Block::new("days", columns, options.trials.unwrap_or(TRIALS), day)])
}

/// Evaluates the samples of the trials.
///
/// # Errors
/// Those of [`trials`].
pub fn report(options: RunOptions, samples: &[Samples]) -> Result<Report, Error> {
    let scalar = choose_scalar(Robot::NAME, options.scalar, &ScalarKind::ALL, ScalarKind::F32)?;
    let days = &samples[0];
    let points: Vec<Row> = (0..15).map(|point| row(days, point)).collect();
    let column = |index: usize| mean(&days.column(15 * COLUMNS + index));
    let line = Line {
        unfiltered_cm: column(0),
        ekf_cm: column(1),
        aekf_cm: column(2),
        ours_cm: column(3),
        ours_calibrated_cm: column(4),
    };
    let (mean, trials) = (mean_row(&points), days.len());
    Ok(Report { system: Robot::NAME, seed: options.seed, trials, scalar, points, mean, line })
}

fn row(days: &Samples, point: usize) -> Row {
    let column = |index: usize| mean(&days.column(point * COLUMNS + index));
    let [unfiltered, from_truth, adaptive_from_truth, ekf, aekf, beside, ours, calibrated] =
        std::array::from_fn(column);
    let place = scenario::points()[point];
    Row {
        published: TABLE_1[point],
        from_the_truth: PositionErrors {
            unfiltered_cm: unfiltered,
            ekf_cm: from_truth,
            aekf_cm: adaptive_from_truth,
        },
        honest_start: PositionErrors { unfiltered_cm: unfiltered, ekf_cm: ekf, aekf_cm: aekf },
        aekf_from_10_cm_beside_cm: beside,
        ours_cm: ours,
        ours_calibrated_cm: calibrated,
        limit_cm: 100.0 * mean_error_limit(place, Knowledge::Nothing),
        limit_calibrated_cm: 100.0 * mean_error_limit(place, Knowledge::Anchors),
    }
}

fn mean_row(rows: &[Row]) -> Row {
    let of = |field: fn(&Row) -> f64| mean(&rows.iter().map(field).collect::<Vec<_>>());
    Row {
        published: TABLE_1_MEAN,
        from_the_truth: PositionErrors {
            unfiltered_cm: of(|row| row.from_the_truth.unfiltered_cm),
            ekf_cm: of(|row| row.from_the_truth.ekf_cm),
            aekf_cm: of(|row| row.from_the_truth.aekf_cm),
        },
        honest_start: PositionErrors {
            unfiltered_cm: of(|row| row.honest_start.unfiltered_cm),
            ekf_cm: of(|row| row.honest_start.ekf_cm),
            aekf_cm: of(|row| row.honest_start.aekf_cm),
        },
        aekf_from_10_cm_beside_cm: of(|row| row.aekf_from_10_cm_beside_cm),
        ours_cm: of(|row| row.ours_cm),
        ours_calibrated_cm: of(|row| row.ours_calibrated_cm),
        limit_cm: of(|row| row.limit_cm),
        limit_calibrated_cm: of(|row| row.limit_calibrated_cm),
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, trials, .. } = self;
        writeln!(f, "robot: error of the mean of 50 positions, cm; {trials} days, seed {seed}")?;
        let mut table = output::table();
        table.set_header([
            "",
            "published\nLSQ  EKF  AEKF",
            "started at the truth\nLSQ  EKF  AEKF",
            "10 cm beside\nAEKF",
            "honest start\nEKF  AEKF",
            "ours\nas is  calibrated",
            "limit\nas is  calibrated",
        ]);
        let three = |e: &PositionErrors| {
            format!("{:5.2} {:5.2} {:5.2}", e.unfiltered_cm, e.ekf_cm, e.aekf_cm)
        };
        let mut add = |name: String, row: &Row| {
            let honest = &row.honest_start;
            table.add_row([
                name,
                three(&row.published),
                three(&row.from_the_truth),
                format!("{:5.2}", row.aekf_from_10_cm_beside_cm),
                format!("{:5.2} {:5.2}", honest.ekf_cm, honest.aekf_cm),
                format!("{:5.2} {:5.2}", row.ours_cm, row.ours_calibrated_cm),
                format!("{:5.2} {:5.2}", row.limit_cm, row.limit_calibrated_cm),
            ]);
        };
        for (index, row) in self.points.iter().enumerate() {
            add(format!("P{}", index + 1), row);
        }
        add("mean".to_owned(), &self.mean);
        writeln!(f, "{table}")?;
        let line = &self.line;
        writeln!(
            f,
            "straight line, RMSE, cm: LSQ {:.1}, EKF {:.1}, AEKF {:.1}, ours {:.1}, calibrated {:.1}",
            line.unfiltered_cm, line.ekf_cm, line.aekf_cm, line.ours_cm, line.ours_calibrated_cm
        )
    }
}
