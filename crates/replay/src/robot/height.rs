//! The height of a tag for which none is given: found from its ranges, or not at all.

use kestirim_uwb_tracker::{HeightFinder, RangeSample};

use super::{Error, Event, MOST, Range, Setup};

/// The largest standard deviation that an unknown height may add to the position, m: as much as everything else does
/// among typical anchors (the book's table has 9 to 21 cm).
const LARGEST_SIGMA_M: f64 = 0.15;
/// The smallest height above the floor up to which a tag is searched for, m, as in the finder.
const LEAST_ROOM_M: f64 = 2.0;
/// Time between the parts of a recording, µs: longer than ranges are fresh.
const APART_US: u64 = 10_000_000;

/// The height of a tag, found from its ranges.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundHeight {
    /// The height, m.
    pub metres: f64,
    /// Its standard deviation, m.
    pub sigma_m: f64,
    /// The standard deviation that it adds to the position, m.
    pub position_sigma_m: f64,
    /// The biases of the anchors at this height, m. Empty for calibrated anchors, which keep their own.
    pub biases: Vec<f64>,
    /// Whether the ranges tell the height; otherwise it is anywhere between the floor and the highest anchor, and does
    /// not matter.
    pub is_of_ranges: bool,
}

impl FoundHeight {
    /// Finds the height of a tag from its ranges alone, in parts that were recorded one after the other.
    ///
    /// # Errors
    /// [`Error::Anchors`] if the anchors are unsuitable, [`Error::HeightUnknown`] or [`Error::HeightVague`] if the
    /// ranges do not tell the height.
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

    /// Returns the height if it is accurate enough for positions.
    ///
    /// # Errors
    /// [`Error::HeightVague`] if positions would be too uncertain.
    fn accepted(self) -> Result<Self, Error> {
        let Self { sigma_m, position_sigma_m, .. } = self;
        if position_sigma_m <= LARGEST_SIGMA_M {
            return Ok(self);
        }
        Err(Error::HeightVague { sigma_m, position_sigma_m })
    }
}

/// The height of a tag among anchors so far apart that it hardly matters: between the floor and the highest anchor, or
/// 2 m above the floor if that is higher; `None` if it matters.
///
/// A range over the distance d is longer by Δ²/2d for a height difference Δ: 5 cm for 2 m over 40 m.
fn of_no_matter(anchors: &[[f64; 3]]) -> Option<FoundHeight> {
    let count = anchors.len() as f64;
    let centre = [0, 1].map(|axis| anchors.iter().map(|place| place[axis]).sum::<f64>() / count);
    let reach = anchors.iter().map(|[x, y, _]| (x - centre[0]).hypot(y - centre[1]));
    let reach = reach.fold(0.0, f64::max);
    let heights = || anchors.iter().map(|place| place[2]);
    let floor = heights().fold(0.0, f64::min);
    let highest = heights().fold(floor + LEAST_ROOM_M, f64::max);
    let position_sigma_m = (highest - floor).powi(2) / (2.0 * reach);
    // The height is assumed to be uniformly distributed.
    let sigma_m = (highest - floor) / 12_f64.sqrt();
    let metres = 0.5 * (floor + highest);
    let found =
        FoundHeight { metres, sigma_m, position_sigma_m, biases: vec![], is_of_ranges: false };
    (position_sigma_m <= LARGEST_SIGMA_M).then_some(found)
}

/// A search for the height in ranges as they come in.
#[derive(Debug)]
pub struct HeightSearch {
    search: HeightFinder<f64, MOST>,
    of_no_matter: Option<FoundHeight>,
    /// The number of anchors that are not calibrated.
    uncalibrated: usize,
}

impl HeightSearch {
    /// A search among the anchors of a setup.
    ///
    /// # Errors
    /// [`Error::Anchors`] if the anchors are unsuitable.
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

    /// Processes a range, at a time in µs since the recording began; returns whether the height may have changed.
    pub fn take(&mut self, time_us: u64, range: &Range) -> bool {
        let (anchor, range) = (range.anchor, range.metres);
        // A range that a tracker rejects tells nothing here either.
        self.search.range(&RangeSample { time_us, anchor, range }).unwrap_or(false)
    }

    /// The height, if the ranges tell it.
    ///
    /// # Errors
    /// [`Error::HeightUnknown`] or [`Error::HeightVague`] if they do not.
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
