//! Tags among ultra-wideband anchors.
//!
//! [`Sensors`] put measurements in the order of time, a [`Setup`] holds what is known beforehand, and [`track`]
//! computes a [`Trace`] from both. Frame: *room*, right-handed with z up, in which the anchors are given.

mod anchors;
mod check;
mod course;
mod error;
mod event;
mod exchange;
mod height;
mod order;
mod setup;
mod smoother;
pub mod survey;
mod trace;
mod trackers;
mod tuning;

pub use self::anchors::Anchors;
pub use self::check::{KnownHeight, check};
pub use self::course::Course;
pub use self::error::Error;
pub use self::event::{Difference, Event, Inertial, Range, RangeRow, Sensors, Wheels};
pub use self::exchange::Exchange;
pub use self::height::{FoundHeight, HeightSearch};
pub use self::setup::{Dimensions, Setup, TrackerKind};
pub use self::smoother::{Smoothed, Tracked, Unsmoothed, smooth};
pub use self::trace::{Epoch, Trace, doubts, follow, mirrored, track};
pub use self::trackers::{
    Beginning, Follow, Noise, Reception, build, build_changed, build_published,
};
pub use self::tuning::Tuning;

/// The largest number of anchors for which the trackers are built.
pub const MOST: usize = 32;
