//! A user on the ground, heard by a drone.
//!
//! A [`Search`] gives an [`Estimate`] for each [`Stop`] at which the drone measured. Places are metres in the plane,
//! heights metres above the user.

mod among_buildings;
mod check;
mod cloud;
mod density;
mod doubt;
mod error;
mod estimate;
mod flight;
mod misfit;
mod moving;
mod open_ground;
mod search;
mod trace;

pub use self::check::check;
pub use self::cloud::Cloud;
pub use self::density::Region;
pub use self::doubt::Doubt;
pub use self::error::Error;
pub use self::estimate::{Estimate, Next};
pub use self::flight::{
    Area, EnvironmentKind, MOST_CORNERS, Quantity, Stop, WAVELENGTH_M, level_step, wavelength_m,
};
pub use self::misfit::Misfit;
pub use self::open_ground::{MOST_DRAWN, MOST_PLACES, POINTS_OPEN};
pub use self::search::{BEYOND_M, MOST, POINTS, Search, level_prior, thinned};
pub use self::trace::{Flown, Other, Track};
