#![doc = include_str!("../README.md")]
#![no_std]

mod beacon;
mod error;
mod locator;
mod orbit;
mod printed;
mod tracker;

pub use beacon::{Beacon, BeaconEstimate};
pub use error::Error;
pub use locator::Locator;
pub use orbit::{Height, Orbit, Waypoint};
pub use printed::{PrintedLocator, PrintedSettings};
pub use tracker::{Motion, TrackEstimate, Tracker};
