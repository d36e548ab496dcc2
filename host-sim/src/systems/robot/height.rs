//! The height of a tag of which nobody says how high it is: from its ranges, or not at all.

use std::sync::OnceLock;

use kestirim_uwb_tracker::{HeightFinder, RangeSample};

use super::recording::anchors::MOST;
use super::recording::event::{Event, Range};
use super::recording::{Heights, Recording};
use super::settings::{Dimensions, Setup};
use super::track::follow::{anchors, refused};
use crate::Error;
use crate::system::Settings;

/// What an unknown height may add to the position's standard deviation, m: as much as everything else does among
/// anchors as they come (the book's table has 9 to 21 cm).
const LARGEST_SIGMA_M: f64 = 0.15;
/// A tag is looked for so high above the floor at least, m, as the finder looks.
const LEAST_ROOM_M: f64 = 2.0;
/// Time between the parts of a recording, µs: longer than ranges are fresh.
const APART_US: u64 = 10_000_000;
/// What helps if the ranges do not tell the height.
const MISSING: &str = "expected --height, metres above the floor or a file (or --dim 3)";

/// The height as the ranges tell it.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundHeight {
    /// The height, m.
    pub metres: f64,
    /// Its standard deviation, m.
    pub sigma_m: f64,
    /// What it adds to the position's standard deviation, m.
    pub position_sigma_m: f64,
    /// What the anchors measure too long at this height, m. Empty of calibrated ones, which keep what was measured.
    pub biases: Vec<f64>,
    /// Whether the ranges tell it; else it is anywhere between floor and highest anchor, and does not matter.
    pub is_of_ranges: bool,
}

impl FoundHeight {
    /// As people read it.
    pub fn in_words(&self) -> String {
        let Self { metres, sigma_m, position_sigma_m, .. } = self;
        let moved = 100.0 * position_sigma_m;
        let whence = if self.is_of_ranges { " from the ranges" } else { ", anywhere" };
        format!("{metres:.2} ± {sigma_m:.2} m{whence}, the position ± {moved:.1} cm by it")
    }

    /// The same, if positions may depend on it.
    ///
    /// # Errors
    /// [`Error::Usage`]: they would be too uncertain.
    fn accepted(self) -> Result<Self, Error> {
        if self.position_sigma_m <= LARGEST_SIGMA_M {
            return Ok(self);
        }
        let (sigma_m, moved) = (self.sigma_m, 100.0 * self.position_sigma_m);
        Err(Error::Usage(format!(
            "the ranges tell the tag's height to ± {sigma_m:.2} m only, and its position to ± {moved:.0} cm: \
             {MISSING}"
        )))
    }
}

/// The height of a tag among anchors so far apart that it hardly matters: between the floor and the highest anchor, or 2 m
/// above the floor if that is higher; none if it matters.
///
/// A range over the distance d is longer by Δ²/2d for a difference Δ of heights: 5 cm for 2 m over 40 m.
fn of_no_matter(anchors: &[[f64; 3]]) -> Option<FoundHeight> {
    let count = anchors.len() as f64;
    let centre = [0, 1].map(|axis| anchors.iter().map(|place| place[axis]).sum::<f64>() / count);
    let reach = anchors.iter().map(|[x, y, _]| (x - centre[0]).hypot(y - centre[1]));
    let reach = reach.fold(0.0, f64::max);
    let heights = || anchors.iter().map(|place| place[2]);
    let floor = heights().fold(0.0, f64::min);
    let highest = heights().fold(floor + LEAST_ROOM_M, f64::max);
    let position_sigma_m = (highest - floor).powi(2) / (2.0 * reach);
    // Evenly distributed.
    let sigma_m = (highest - floor) / 12_f64.sqrt();
    let metres = 0.5 * (floor + highest);
    let found =
        FoundHeight { metres, sigma_m, position_sigma_m, biases: vec![], is_of_ranges: false };
    (position_sigma_m <= LARGEST_SIGMA_M).then_some(found)
}

/// Finds the height from ranges as they come in.
#[derive(Debug)]
pub(super) struct Finder {
    search: HeightFinder<f64, MOST>,
    of_no_matter: Option<FoundHeight>,
    /// How many anchors are not calibrated.
    uncalibrated: usize,
}

impl Finder {
    /// For the anchors of a setup.
    ///
    /// # Errors
    /// [`Error::Usage`] if they will not do.
    pub(super) fn new(setup: &Setup) -> Result<Self, Error> {
        let places = anchors::<f64>(setup);
        let (finder, uncalibrated) = if setup.biases.is_some() {
            (HeightFinder::calibrated(&places), 0)
        } else {
            (HeightFinder::uncalibrated(&places), places.len())
        };
        let of_no_matter = of_no_matter(&setup.anchors);
        Ok(Self { search: finder.map_err(refused)?, of_no_matter, uncalibrated })
    }

    /// Takes in a range, at a time in µs since the recording began; whether the height may be another then.
    pub(super) fn take(&mut self, time_us: u64, range: &Range) -> bool {
        let (anchor, range) = (range.anchor, range.metres);
        // What a tracker refuses says nothing here either.
        self.search.range(&RangeSample { time_us, anchor, range }).unwrap_or(false)
    }

    /// The height, if the ranges tell it.
    ///
    /// # Errors
    /// [`Error::Usage`]: they do not.
    pub(super) fn found(&self) -> Result<FoundHeight, Error> {
        if let Some(found) = &self.of_no_matter {
            return Ok(found.clone());
        }
        let Some(height) = self.search.height() else {
            let problem = format!("the ranges do not tell the tag's height: {MISSING}");
            return Err(Error::Usage(problem));
        };
        let found = FoundHeight {
            metres: height.metres,
            sigma_m: height.sigma,
            position_sigma_m: height.position_sigma,
            biases: height.biases[..self.uncalibrated].to_vec(),
            is_of_ranges: true,
        };
        found.accepted()
    }
}

/// The height of a recording with uncalibrated and with calibrated anchors: searched once, asked for at every slider.
#[derive(Debug, Clone, Default)]
pub(super) struct FoundOnce([OnceLock<Result<FoundHeight, String>>; 2]);

/// Whether nobody says how high the tag is.
pub(super) fn is_missing(recording: &Recording, settings: &Settings) -> bool {
    settings.chosen::<Dimensions>("dim") == Dimensions::Two
        && recording.heights == Heights::Unknown
        && !settings.is_given("height")
}

/// The height at which the tag of a recording is, from its ranges alone.
///
/// # Errors
/// [`Error::Usage`], naming the option that is missing: the ranges do not tell it.
pub(super) fn of_recording(recording: &Recording, setup: &Setup) -> Result<FoundHeight, Error> {
    let found = &recording.found_height.0[usize::from(setup.biases.is_some())];
    let found = found.get_or_init(|| search(recording, setup).map_err(|error| error.to_string()));
    found.clone().map_err(Error::Usage)
}

fn search(recording: &Recording, setup: &Setup) -> Result<FoundHeight, Error> {
    let mut finder = Finder::new(setup)?;
    if finder.of_no_matter.is_some() {
        return finder.found();
    }
    let mut begun_us = 0;
    for part in &recording.parts {
        let start_us = part.events.iter().map(Event::time_us).min().unwrap_or_default();
        let mut latest_us = begun_us;
        for event in &part.events {
            let Event::Range(range) = event else { continue };
            let since_us = range.time_us.saturating_sub(start_us).max(0) as u64;
            let time_us = since_us.saturating_add(begun_us);
            finder.take(time_us, range);
            latest_us = latest_us.max(time_us);
        }
        finder.search.end_place();
        begun_us = latest_us.saturating_add(APART_US);
    }
    finder.found()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_height_matters_in_a_room_and_not_in_a_field() {
        let corners = |reach: f64| {
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                .map(|[x, y]| [reach * x, reach * y, 1.5])
        };
        assert_eq!(of_no_matter(&corners(3.0)), None);
        let found = of_no_matter(&corners(20.0)).unwrap();
        assert!((found.metres - 1.0).abs() < 1e-9 && found.position_sigma_m < 0.1, "{found:?}");
    }
}
