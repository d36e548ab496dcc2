//! Search for a moving user: old measurements tell only where the user was.

use std::ops::Range;

use rayon::prelude::*;

use super::{EnvironmentKind, Estimate, Quantity, Search};
use crate::metrics::distance;

/// The distance, in standard deviations of both, beyond which two places are different.
const APART: f64 = 3.0;
/// The fewest measurements in each third of a flight from which movement is judged.
const FEWEST: usize = 8;

impl Search<'_> {
    /// Estimates, each from the measurements of the last seconds before it alone.
    pub(super) fn while_moving(
        &self,
        environment: Option<EnvironmentKind>,
        quantity: Quantity,
    ) -> Vec<Estimate> {
        let count = self.stops.len();
        let asked: Vec<usize> = (0..count).filter(|number| self.is_asked(*number)).collect();
        let find = |last: &usize| {
            let begin = self.stops[*last].t - self.window_s.unwrap_or(f64::INFINITY);
            let first = self.stops[..*last].partition_point(|stop| stop.t < begin);
            let is_on_the_way = last + 1 < count;
            self.of_part(first..last + 1, is_on_the_way, environment, quantity)
        };
        asked.par_iter().filter_map(find).collect()
    }

    /// The distance (m) between the places from the first and the last third of a flight, for a user who is assumed to
    /// stay; `None` if it may be chance.
    pub fn moved(&self, environment: Option<EnvironmentKind>, quantity: Quantity) -> Option<f64> {
        let count = self.stops.len();
        if count < 3 * FEWEST || self.window_s.is_some() {
            return None;
        }
        let before = self.of_part(0..count / 3, true, environment, quantity)?;
        let after = self.of_part(count - count / 3..count, true, environment, quantity)?;
        let apart = distance(before.place, after.place);
        (apart > APART * before.sd_m.hypot(after.sd_m)).then_some(apart)
    }

    /// The last estimate from some of the measurements.
    fn of_part(
        &self,
        part: Range<usize>,
        is_rough: bool,
        environment: Option<EnvironmentKind>,
        quantity: Quantity,
    ) -> Option<Estimate> {
        let search = Search {
            stops: self.stops.get(part.clone())?,
            truth: self.truth.get(part.clone()).unwrap_or_default(),
            area: self.area.clone(),
            most: 1,
            window_s: None,
            is_rough,
            ..*self
        };
        let found = search.find(environment, quantity).pop()?;
        Some(Estimate { stop: part.start + found.stop, first: part.start, ..found })
    }
}
