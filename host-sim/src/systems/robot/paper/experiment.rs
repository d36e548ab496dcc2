//! `host-sim run robot`: the paper's Table 1, with the start made visible.
//!
//! Every filter of the paper is run twice: started at the surveyed point, as its numbers can only have come
//! about, and started at the first trilateration, as anyone has to who does not know yet where the robot is.

use std::fmt;

use indicatif::ParallelProgressIterator;
use kestirim_replay::ScalarKind;
use kestirim_replay::robot::{
    self, Beginning, Epoch, Follow, Noise, RangeRow, Sensors, Setup, TrackerKind, build,
    build_published,
};
use rayon::prelude::*;
use serde::Serialize;

use super::limit::{Knowledge, mean_error_limit};
use super::published::{PositionErrors, TABLE_1, TABLE_1_MEAN};
use crate::metrics::{distance, mean};
use crate::random::stream;
use crate::system::{RunOptions, System, choose_scalar};
use crate::systems::robot::Robot;
use crate::systems::robot::account::accuracy::Accuracy;
use crate::systems::robot::settings::of_the_office;
use crate::systems::robot::simulate::scenario::{self, EPOCHS, Office};
use crate::systems::robot::track::refused;
use crate::{Error, output};

/// Repetitions unless told otherwise: the mean of the table is then good to a fiftieth.
const TRIALS: u32 = 200;
/// In how many ways a point is measured.
const COLUMNS: usize = 8;

/// Errors in cm, of the mean of 50 positions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Row {
    /// As published.
    pub published: PositionErrors,
    /// The paper's protocol, its filters started at the surveyed point.
    pub from_the_truth: PositionErrors,
    /// The same filters, started at the first trilateration.
    pub honest_start: PositionErrors,
    /// The same adaptive filter, started 10 cm beside the surveyed point.
    pub aekf_from_10_cm_beside_cm: f64,
    /// This library's default without calibration.
    pub ours_cm: f64,
    /// And with the anchors calibrated at six marked places.
    pub ours_calibrated_cm: f64,
    /// What the best unbiased estimator errs by, if nothing is known of the biases.
    pub limit_cm: f64,
    /// The same if each anchor's bias is known.
    pub limit_calibrated_cm: f64,
}

/// The straight line: root mean square errors, cm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Line {
    /// Trilateration alone.
    pub unfiltered_cm: f64,
    /// The paper's filters from an honest start.
    pub ekf_cm: f64,
    /// And the adaptive one.
    pub aekf_cm: f64,
    /// This library's default without calibration.
    pub ours_cm: f64,
    /// And with it.
    pub ours_calibrated_cm: f64,
}

/// What the command prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    system: &'static str,
    pub(super) seed: u64,
    pub(super) trials: u32,
    pub(super) scalar: ScalarKind,
    pub(super) points: Vec<Row>,
    pub(super) mean: Row,
    pub(super) line: Line,
}

/// Runs the experiment.
///
/// # Errors
/// If the scalar is not supported.
pub fn run(options: RunOptions) -> Result<Report, Error> {
    let scalar = choose_scalar(Robot::NAME, options.scalar, &ScalarKind::ALL, ScalarKind::F32)?;
    let trials = options.trials.unwrap_or(TRIALS);
    let days: Result<Vec<Day>, _> = (0..u64::from(trials))
        .into_par_iter()
        .progress_with(output::progress(u64::from(trials), "days"))
        .map(|trial| Day::run(options.seed, trial, scalar))
        .collect();
    let days = days.map_err(refused)?;
    let points: Vec<Row> = (0..15).map(|point| row(&days, point)).collect();
    let lines: Vec<[f64; 5]> = days.iter().map(|day| day.line).collect();
    let column = |index: usize| mean(&lines.iter().map(|line| line[index]).collect::<Vec<_>>());
    let line = Line {
        unfiltered_cm: column(0),
        ekf_cm: column(1),
        aekf_cm: column(2),
        ours_cm: column(3),
        ours_calibrated_cm: column(4),
    };
    let mean = mean_row(&points);
    Ok(Report { system: Robot::NAME, seed: options.seed, trials, scalar, points, mean, line })
}

/// One office on one day.
struct Day {
    /// Errors of the columns at each point, cm.
    points: [[f64; COLUMNS]; 15],
    /// Errors of the five ways to follow the line, cm.
    line: [f64; 5],
}

impl Day {
    fn run(seed: u64, trial: u64, scalar: ScalarKind) -> Result<Self, robot::Error> {
        let mut rng = stream(seed, trial);
        let office = Office::draw(&mut rng);
        let places = scenario::points();
        let measured = places.map(|place| office.measure(&mut rng, &[place; EPOCHS]));
        let plain = of_the_office(scalar);
        let calibrated = Setup { biases: Some(office.calibrate(&mut rng)), ..plain.clone() };
        let mut points = [[0.0; COLUMNS]; 15];
        for ((errors, rows), &place) in points.iter_mut().zip(&measured).zip(&places) {
            let trackers = trackers(&plain, &calibrated, place, trial)?;
            *errors = trackers.map(|mut tracker| static_error_cm(tracker.as_mut(), rows, place));
        }
        let path = scenario::line();
        let rows = office.measure(&mut rng, &path);
        let honest = |noise| Beginning { start: None, noise };
        let followers = [
            build(&Setup { tracker: TrackerKind::Lsq, ..plain.clone() })?,
            build_published(&plain, honest(Noise::Fixed))?,
            build_published(&plain, honest(Noise::Adapted))?,
            build(&plain)?,
            build(&calibrated)?,
        ];
        let line = followers.map(|mut tracker| line_error_cm(tracker.as_mut(), &rows, &path));
        Ok(Self { points, line })
    }
}

/// The ways to measure a point, in the order of the columns.
fn trackers(
    plain: &Setup,
    calibrated: &Setup,
    place: [f64; 2],
    trial: u64,
) -> Result<[Box<dyn Follow>; COLUMNS], robot::Error> {
    // Beside the point, every day in another direction: turned by the golden angle.
    let angle = 2.399_963_229_728_653 * trial as f64;
    let beside = [place[0] + 0.1 * angle.cos(), place[1] + 0.1 * angle.sin()];
    let published = |start, noise| build_published(plain, Beginning { start, noise });
    Ok([
        build(&Setup { tracker: TrackerKind::Lsq, ..plain.clone() })?,
        published(Some(place), Noise::Fixed)?,
        published(Some(place), Noise::Adapted)?,
        published(None, Noise::Fixed)?,
        published(None, Noise::Adapted)?,
        published(Some(beside), Noise::Adapted)?,
        build(plain)?,
        build(calibrated)?,
    ])
}

fn positions(tracker: &mut dyn Follow, rows: &[RangeRow]) -> Vec<Epoch> {
    robot::follow(tracker, &Sensors::ranges(rows.to_vec()).events()).epochs
}

/// The paper's measure: the error of the mean of all positions, cm.
fn static_error_cm(tracker: &mut dyn Follow, rows: &[RangeRow], place: [f64; 2]) -> f64 {
    let epochs = positions(tracker, rows);
    let found: Vec<[f64; 3]> = epochs.iter().filter_map(|epoch| epoch.position).collect();
    let coordinate =
        |axis: usize| mean(&found.iter().map(|position| position[axis]).collect::<Vec<_>>());
    100.0 * distance([coordinate(0), coordinate(1)], place)
}

fn line_error_cm(tracker: &mut dyn Follow, rows: &[RangeRow], path: &[[f64; 2]]) -> f64 {
    let epochs = positions(tracker, rows);
    let pairs: Vec<_> =
        epochs.iter().zip(path).map(|(epoch, &truth)| (epoch.position, truth)).collect();
    Accuracy::of(&pairs).map_or(0.0, |accuracy| 100.0 * accuracy.rmse_m)
}

fn row(days: &[Day], point: usize) -> Row {
    let column =
        |index: usize| mean(&days.iter().map(|day| day.points[point][index]).collect::<Vec<_>>());
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
