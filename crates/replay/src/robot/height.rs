//! The height of a tag of which nobody says how high it is: from its ranges, or not at all.

use kestirim_uwb_tracker::{HeightFinder, RangeSample};

use super::{Error, Event, MOST, Range, Setup};

/// What an unknown height may add to the position's standard deviation, m: as much as everything else does among
/// anchors as they come (the book's table has 9 to 21 cm).
const LARGEST_SIGMA_M: f64 = 0.15;
/// A tag is looked for so high above the floor at least, m, as the finder looks.
const LEAST_ROOM_M: f64 = 2.0;
/// Time between the parts of a recording, µs: longer than ranges are fresh.
const APART_US: u64 = 10_000_000;

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
    /// The height at which the tag is whose parts were recorded one after the other, from its ranges alone.
    ///
    /// # Errors
    /// [`Error::Anchors`] if they will not do, [`Error::HeightUnknown`] or [`Error::HeightVague`] if the ranges do not
    /// tell it.
    pub fn of_parts<'a>(
        setup: &Setup,
        parts: impl IntoIterator<Item = &'a [Event]>,
    ) -> Result<Self, Error> {
        let mut finder = HeightSearch::new(setup)?;
        if finder.of_no_matter.is_some() {
            return finder.found();
        }
        let mut begun_us = 0;
        for events in parts {
            let start_us = events.iter().map(Event::time_us).min().unwrap_or_default();
            let mut latest_us = begun_us;
            for event in events {
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

    /// The same, if positions may depend on it.
    ///
    /// # Errors
    /// [`Error::HeightVague`]: they would be too uncertain.
    fn accepted(self) -> Result<Self, Error> {
        let Self { sigma_m, position_sigma_m, .. } = self;
        if position_sigma_m <= LARGEST_SIGMA_M {
            return Ok(self);
        }
        Err(Error::HeightVague { sigma_m, position_sigma_m })
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
pub struct HeightSearch {
    search: HeightFinder<f64, MOST>,
    of_no_matter: Option<FoundHeight>,
    /// How many anchors are not calibrated.
    uncalibrated: usize,
}

impl HeightSearch {
    /// For the anchors of a setup.
    ///
    /// # Errors
    /// [`Error::Anchors`] if they will not do.
    pub fn new(setup: &Setup) -> Result<Self, Error> {
        let places = setup.anchors::<f64>();
        let (finder, uncalibrated) = if setup.biases.is_some() {
            (HeightFinder::calibrated(&places), 0)
        } else {
            (HeightFinder::uncalibrated(&places), places.len())
        };
        let of_no_matter = of_no_matter(&setup.anchors);
        Ok(Self { search: finder?, of_no_matter, uncalibrated })
    }

    /// Takes in a range, at a time in µs since the recording began; whether the height may be another then.
    pub fn take(&mut self, time_us: u64, range: &Range) -> bool {
        let (anchor, range) = (range.anchor, range.metres);
        // What a tracker refuses says nothing here either.
        self.search.range(&RangeSample { time_us, anchor, range }).unwrap_or(false)
    }

    /// The height, if the ranges tell it.
    ///
    /// # Errors
    /// [`Error::HeightUnknown`] or [`Error::HeightVague`]: they do not.
    pub fn found(&self) -> Result<FoundHeight, Error> {
        if let Some(found) = &self.of_no_matter {
            return Ok(found.clone());
        }
        let height = self.search.height().ok_or(Error::HeightUnknown)?;
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
