//! Satellite navigation: precise point positioning from files.
//!
//! A [`Recording`] is read with all that must be known for a position; [`follow`] computes a [`Followed`] from it.
//! Positions are ECEF, m; times are s since the midnight before the first epoch. [`Live`] follows a receiver that is
//! running.

mod accuracy;
mod agreement;
mod broadcast;
mod calendar;
mod check;
mod choices;
mod coverage;
mod doubts;
mod feed;
mod fixing;
mod followed;
mod live;
mod model;
mod orbit_jumps;
mod outage;
mod products;
mod recording;
mod shelf;
mod single;
mod smoothed;
mod ssr;
mod told;
mod track_file;
mod whole_biases;

pub use self::accuracy::{Accuracy, BEGINNING};
pub use self::check::check;
pub use self::choices::{
    Ambiguities, FilterKind, Method, STATES, STATES_OF_ALL, STATES_WITH_GALILEO, Systems,
};
pub use self::coverage::names;
pub use self::fixing::Fixing;
pub use self::followed::{Both, Fix, Followed, Last, Order, Pass, Slips, Tally, follow};
pub use self::live::{Live, Now};
pub use self::model::{Epoch, ephemeris, epoch};
pub use self::outage::{Outage, Outages, Unused};
pub use self::products::{Products, Satellite, Unusable};
pub use self::recording::{FEWEST_SATELLITES, Paths, Recording};
pub use self::shelf::Shelf;
pub use self::track_file::track_text;
pub use self::whole_biases::WholeBiases;
