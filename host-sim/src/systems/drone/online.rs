//! Where a user is, while the drone still flies.

use super::area::Area;
use super::flight::{Flight, Quantity, Stop};
use super::search::{Estimate, MOST_OPEN, Search};
use crate::table::FARTHEST_POSITION;

/// Most measurements that a place is found from.
pub const MOST: usize = MOST_OPEN;

/// Where the user is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// As x and y of the measurements, m.
    pub place: [f64; 2],
    /// Root mean square distance that the filter expects, m.
    pub sd_m: f64,
}

/// Finds the user over open ground from at most [`MOST`] path losses, as a replay does; none if no place explains
/// them, and from fewer than three.
pub fn locate(stops: Vec<Stop>, area: Option<&Area>) -> Option<Found> {
    if stops.len() < 3 {
        return None;
    }
    let flight = Flight { quantity: Quantity::PathLoss, stops, unusable: 0 };
    let estimates = Search::new(&flight, area, None, true).in_free_space(flight.quantity);
    let Estimate { place, sd_m, .. } = *estimates.last()?;
    Some(Found { place, sd_m })
}

impl Stop {
    /// Whether it was measured somewhere on earth, and a channel can use it.
    pub fn is_somewhere(&self) -> bool {
        self.place.iter().all(|coordinate| coordinate.abs() <= FARTHEST_POSITION)
            && self.is_usable()
    }
}
