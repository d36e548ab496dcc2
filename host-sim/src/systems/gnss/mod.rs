//! GNSS receivers at a fixed or moving place.
//!
//! `files` reads observations and what services tell of satellites; `products` and `recording` put together what
//! a filter needs. `follow` feeds one and counts what becomes of the observations, `accuracy` compares with the
//! truth; `session` runs one filter or all for a [replay](replay::Replay).
//!
//! Times are seconds since the midnight before the first epoch, positions those of the marker, ECEF.

pub mod accounts;
pub mod accuracy;
pub mod comparison;
pub mod experiment;
pub mod files;
pub mod follow;
pub mod options;
pub mod outage;
pub mod products;
pub mod recording;
pub mod replay;
pub mod report;
pub mod session;
pub mod sky;
pub mod tables;
