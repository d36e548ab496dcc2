#![doc = include_str!("../README.md")]
#![no_std]

mod area;
mod beacon;
mod by_place;
mod error;
mod ground;
mod informative;
mod level_step;
mod locator;
mod orbit;
mod published;
mod search;
mod seen;
#[cfg(feature = "serde")]
mod snapshot;
mod thinned;
mod tracker;

pub use area::{Area, Within};
pub use beacon::{Beacon, BeaconEstimate};
pub use by_place::ByPlace;
pub use error::Error;
pub use ground::{GroundEstimate, GroundSearch};
pub use informative::Informative;
pub use kestirim_health::{Health, Reason};
pub use level_step::LevelStep;
pub use locator::Locator;
pub use orbit::{Height, Orbit, Waypoint};
pub use published::{PublishedLocator, PublishedSettings};
pub use search::BeaconSearch;
pub use thinned::Thinned;
pub use tracker::{Motion, TrackEstimate, Tracker};
