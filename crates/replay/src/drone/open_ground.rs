//! Search over open ground, through a channel of which nothing is known.

use kestirim_air_to_ground::{Heading, OpenGround};
use kestirim_user_locator::{GroundEstimate, GroundSearch, Informative, Waypoint};
use rayon::prelude::*;

use super::{Cloud, Estimate, MOST_CORNERS, Next, Quantity, Search, level_prior};
use crate::metrics::median;

/// The largest number of distinct places of a flight.
pub const MOST_PLACES: usize = 120;
/// The number of lattice points: with them, a posterior's mean is accurate to one metre per hundred metres of its
/// width.
pub const POINTS_OPEN: usize = 800;
/// The number of estimates of a flight that is enough for drawing.
pub const MOST_DRAWN: usize = 30;
/// The number of lattice points for estimates on the way, of which there are many.
const POINTS_ON_THE_WAY: usize = 200;

/// The search along a recorded flight.
type Ground = GroundSearch<f64, MOST_PLACES, MOST_CORNERS>;

impl Search<'_> {
    /// Estimates after each measurement of a short flight, or after one in several of a long one, including the last.
    pub(super) fn over_open_ground(&self, quantity: Quantity) -> Vec<Estimate> {
        let channel = OpenGround::new(level_prior(quantity, self.wavelength_m));
        let mut search = Box::new(Ground::new(channel, (*self.area).clone()));
        let count = self.stops.len();
        let mut asked = Vec::new();
        for (number, stop) in self.stops.iter().enumerate() {
            let Some(measurement) = self.measurement(stop) else { continue };
            let heading = stop.heading.and_then(|heading| Heading::new(heading).ok());
            search.measure_with_heading(&measurement, &heading.unwrap_or_else(Heading::unknown));
            if self.is_asked(number) {
                asked.push((number, search.clone()));
            }
        }
        let found = |(number, search): &(usize, Box<Ground>)| {
            if number + 1 == count && !self.is_rough {
                self.found::<POINTS_OPEN>(search, *number, quantity)
            } else {
                self.found::<POINTS_ON_THE_WAY>(search, *number, quantity)
            }
        };
        asked.par_iter().filter_map(found).collect()
    }

    fn found<const POINTS: usize>(
        &self,
        search: &Ground,
        stop: usize,
        quantity: Quantity,
    ) -> Option<Estimate> {
        let found = search.estimate::<POINTS>().ok()?;
        let truth = self.truth.get(stop);
        let covered = truth.map(|truth| search.credible(&found, self.inward(*truth), 0.9));
        let is_last = stop + 1 == self.stops.len() && !self.is_rough;
        let next = is_last.then(|| self.next(search, &found)).flatten();
        let cloud =
            self.with_clouds.then(|| Cloud::of_lattice(&found.posterior).moved(self.origin));
        Some(Estimate {
            stop,
            first: 0,
            place: self.outward(found.place),
            sd_m: found.sigma,
            level_db: (quantity == Quantity::Level).then_some(found.fit.level),
            off_db: 0.0,
            covered,
            next,
            cloud,
        })
    }

    /// The place to measure next, at the usual height.
    fn next<const POINTS: usize>(
        &self,
        search: &Ground,
        found: &GroundEstimate<f64, POINTS>,
    ) -> Option<Next> {
        let heights: Vec<f64> = self.stops.iter().map(|stop| stop.height).collect();
        let Informative { waypoint: Waypoint { place, height }, left } =
            search.next_waypoint(found, median(&heights))?;
        Some(Next { place: self.outward(place), height, sd_m: left * found.sigma })
    }
}
