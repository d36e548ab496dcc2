//! The five robust filters on recorded ranges, those of one anchor through a person.
//!
//! A few lines of glue instead of a tracker: this shows the effect of the weights alone.

use std::path::Path;

use host_sim::metrics::mean;
use host_sim::systems::robot::recording::{anchors, points, ranges};
use kestirim_import::Options;
use kestirim_kalman::{ConstantVelocity, Covariance, Gaussian};
use kestirim_robust_kalman::{Block, Decision, Measurement, Robust};
use kestirim_tests::recordings::folder_of;
use kestirim_tests::robot::{BLOCKED, Recording};
use kestirim_uwb_ranging::expected_range;
use nalgebra::{SVector, Vector3};

const ANCHORS: usize = 4;
/// The standard deviation of a range with a clear view, m.
const SIGMA: f64 = 0.05;
/// The power spectral density of the walker's acceleration, m²/s³.
const DENSITY: f64 = 0.3;

/// The root mean square error of a recording, m.
fn follow(folder: &Path, name: &str, biases: &[f64], robust: &Robust<f64>) -> f64 {
    let folder = folder.join(name);
    let anchors = anchors::read(&folder.join("anchors.csv")).expect("anchors");
    let rows = ranges::read_moving(&folder.join("ranges.csv"), &anchors, &Options::default())
        .expect("ranges")
        .0
        .rows;
    let truth = points::read_course(&folder.join("truth.csv"), ["x", "y", "z"]).expect("a truth");
    let places: Vec<Vector3<f64>> =
        anchors.positions.iter().map(|&place| Vector3::from(place)).collect();

    // The initial position is the centre of the anchors.
    let middle = places.iter().sum::<Vector3<f64>>() / places.len() as f64;
    let start = SVector::from([middle.x, middle.y, 0.0, 0.0]);
    let mut tag = Gaussian::new(start, Covariance::from_variances(&[9.0, 9.0, 1.0, 1.0]));
    let mut last_us = rows.first().map_or(0, |row| row.time_us);
    let mut decisions = [Decision::NONE; 2 * ANCHORS];
    let mut squares = Vec::new();
    for epoch in rows.chunk_by(|a, b| a.time_us == b.time_us) {
        let time_us = epoch[0].time_us;
        let seconds = (time_us - last_us) as f64 * 1e-6;
        last_us = time_us;
        tag.advance(&ConstantVelocity::<f64, 2>::new(seconds, DENSITY)).expect("a prediction");
        let Some(place) = truth.held(time_us) else { continue };
        let predicted = SVector::<f64, 2>::from([tag.mean[0], tag.mean[1]]);
        let expected: Vec<_> = epoch
            .iter()
            .filter_map(|row| {
                let expected = expected_range(&predicted, place[2], &places[row.anchor]);
                let innovation = row.range? - biases[row.anchor] - expected.distance;
                Some(([(0, expected.direction[0]), (1, expected.direction[1])], innovation))
            })
            .take(decisions.len())
            .collect();
        let measurements: Vec<_> = expected
            .iter()
            .map(|(row, innovation)| Measurement {
                row,
                innovation: *innovation,
                variance: SIGMA * SIGMA,
            })
            .collect();
        robust.update(&mut tag, &measurements, &mut decisions).expect("an update");
        // The first second, in which the estimate moves from the centre of the room, does not count.
        if let Some([x, y, _]) =
            truth.within(time_us).filter(|_| time_us > rows[0].time_us + 1_000_000)
        {
            squares.push((tag.mean[0] - x).powi(2) + (tag.mean[1] - y).powi(2));
        }
    }
    mean(&squares).sqrt()
}

#[test]
fn a_person_in_the_way_of_an_anchor() {
    let Some(folder) = folder_of("robot") else { return };
    let filters = [
        ("plain", Robust::plain()),
        ("IGG III", Robust::igg3()),
        ("t-test", Robust::t_test()),
        ("iterative IGG III", Robust::iterative_igg3()),
        ("adaptive", Robust::adaptive(Block::new(0, 4))),
    ];
    let errors = filters.map(|(name, robust)| {
        let errors: Vec<f64> = BLOCKED
            .iter()
            .map(|(name, free)| {
                let biases = Recording::read(&folder, free).biases(f64::INFINITY);
                follow(&folder, name, &biases, &robust)
            })
            .collect();
        let each: Vec<String> =
            errors.iter().map(|error| format!("{:.1}", 100.0 * error)).collect();
        println!("{name:18} {:5.1} cm  ({})", 100.0 * mean(&errors), each.join(" "));
        mean(&errors)
    });
    let [plain, .., iterative, _] = errors;
    assert!(iterative < 0.5 * plain, "{iterative} of {plain}");
}
