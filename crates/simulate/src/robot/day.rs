//! One trial in the paper's office: every filter on the same ranges.

use kestirim_replay::ScalarKind;
use kestirim_replay::metrics::{distance, mean, rms};
use kestirim_replay::robot::{
    self, Beginning, Epoch, Follow, Noise, RangeRow, Sensors, Setup, TrackerKind, build,
    build_published,
};

use super::scenario::{self, ANCHORS, EPOCHS, Office};
use crate::random::stream;

/// The number of ways in which a point is measured.
pub const COLUMNS: usize = 8;
/// The names of the ways to measure a point.
pub const WAYS: [&str; COLUMNS] = [
    "lsq",
    "ekf from truth",
    "aekf from truth",
    "ekf",
    "aekf",
    "aekf beside",
    "ours",
    "ours calibrated",
];
/// The names of the ways to follow the line.
pub const LINES: [&str; 5] = ["lsq", "ekf", "aekf", "ours", "ours calibrated"];

/// The errors in one office on one day.
#[derive(Debug)]
pub struct Day {
    /// The errors of each way at each point, cm.
    pub points: [[f64; COLUMNS]; 15],
    /// The errors of the five ways to follow the line, cm.
    pub line: [f64; 5],
}

impl Day {
    /// Simulates the day with this number.
    ///
    /// # Errors
    /// As [`build`].
    pub fn run(seed: u64, trial: u64, scalar: ScalarKind) -> Result<Self, robot::Error> {
        let mut rng = stream(seed, trial);
        let office = Office::draw(&mut rng);
        let places = scenario::points();
        let measured = places.map(|place| office.measure(&mut rng, &[place; EPOCHS]));
        let plain = Setup { scalar, ..Setup::new(&ANCHORS, 0.0) };
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

/// The trackers that measure a point, in the order of the columns.
fn trackers(
    plain: &Setup,
    calibrated: &Setup,
    place: [f64; 2],
    trial: u64,
) -> Result<[Box<dyn Follow>; COLUMNS], robot::Error> {
    // A start beside the point, in another direction every day: rotated by the golden angle.
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
    let pairs = epochs.iter().zip(path);
    let errors: Vec<f64> = pairs
        .filter_map(|(epoch, &truth)| {
            let [x, y, _] = epoch.position?;
            Some(distance([x, y], truth))
        })
        .collect();
    if errors.is_empty() { 0.0 } else { 100.0 * rms(&errors) }
}
