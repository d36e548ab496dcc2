//! The height of a tag of which nobody says how high it is: from its ranges, or not at all.

use kestirim_uwb_tracker::{HeightFinder, RangeSample};
use pyo3::PyResult;

use super::MOST;
use super::events::Rows;
use super::tag::{Setup, unusable};
use crate::error::KestirimError;

/// What an unknown height may add to the position's standard deviation, m.
const LARGEST_SIGMA_M: f64 = 0.15;
/// A tag is looked for so high above the floor at least, m, as the finder looks.
const LEAST_ROOM_M: f64 = 2.0;
/// What helps if the ranges do not tell the height.
const MISSING: &str = "expected height, metres above the floor (or dim=3)";

/// The height as the ranges tell it.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) metres: f64,
    /// Its standard deviation, m.
    pub(super) sigma: f64,
    /// What it adds to the position's standard deviation, m.
    pub(super) position_sigma: f64,
    /// What uncalibrated anchors measure too long at this height, m.
    pub(super) biases: Vec<f64>,
}

/// Among anchors so far apart that the height hardly matters it is anywhere between floor and highest anchor.
fn of_no_matter(anchors: &[[f64; 3]]) -> Option<Found> {
    let count = anchors.len() as f64;
    let centre = [0, 1].map(|axis| anchors.iter().map(|place| place[axis]).sum::<f64>() / count);
    let reach = anchors.iter().map(|[x, y, _]| (x - centre[0]).hypot(y - centre[1]));
    let reach = reach.fold(0.0, f64::max);
    let heights = || anchors.iter().map(|place| place[2]);
    let floor = heights().fold(0.0, f64::min);
    let highest = heights().fold(floor + LEAST_ROOM_M, f64::max);
    let position_sigma = (highest - floor).powi(2) / (2.0 * reach);
    // Evenly distributed.
    let sigma = (highest - floor) / 12_f64.sqrt();
    let found = Found { metres: 0.5 * (floor + highest), sigma, position_sigma, biases: vec![] };
    (position_sigma <= LARGEST_SIGMA_M).then_some(found)
}

/// Finds the height from the ranges of a recording.
pub(super) fn find(setup: &Setup, rows: &Rows<'_>) -> PyResult<Found> {
    let anchors = setup.anchors::<f64>();
    let is_calibrated = setup.biases.is_some();
    let finder = if is_calibrated {
        HeightFinder::<f64, MOST>::calibrated(&anchors)
    } else {
        HeightFinder::uncalibrated(&anchors)
    };
    let mut finder = finder.map_err(unusable)?;
    if let Some(found) = of_no_matter(&setup.anchors) {
        return Ok(found);
    }
    let times_us = rows.times_us();
    let start_us = times_us.iter().map(|(us, _)| *us).min().unwrap_or_default();
    for (time_us, row) in times_us {
        let (anchor, range) = (rows.anchor[row] as usize, rows.range[row]);
        if !range.is_nan() {
            let time_us = (time_us - start_us) as u64;
            // What a tracker refuses says nothing here either.
            let _ = finder.range(&RangeSample { time_us, anchor, range });
        }
    }
    finder.end_place();
    let Some(height) = finder.height() else {
        let sentence = format!("the ranges do not tell the tag's height: {MISSING}");
        return Err(KestirimError::new_err(sentence));
    };
    if height.position_sigma > LARGEST_SIGMA_M {
        let (sigma, moved) = (height.sigma, 100.0 * height.position_sigma);
        return Err(KestirimError::new_err(format!(
            "the ranges tell the tag's height to ± {sigma:.2} m only, and its position to ± {moved:.0} cm: {MISSING}"
        )));
    }
    let uncalibrated = if is_calibrated { 0 } else { anchors.len() };
    Ok(Found {
        metres: height.metres,
        sigma: height.sigma,
        position_sigma: height.position_sigma,
        biases: height.biases[..uncalibrated].to_vec(),
    })
}
