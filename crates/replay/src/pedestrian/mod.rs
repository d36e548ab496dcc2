//! Walks with a sensor on the foot.
//!
//! [`walk`] computes a [`Walk`] from [`Sample`]s according to the [`Options`]; [`trace`] also keeps velocity, attitude
//! and stance at every sample. [`Walk::correct_heading`] removes the drift of the heading if the log has a
//! magnetometer; [`sensor_class`] tells the class of the sensor. [`build`] makes a tracker for a walk in progress.
//! Frame: *room*, z up, x as the foot pointed at the start.

mod carried;
mod check;
mod choices;
mod closed;
mod error;
mod heading;
mod live;
mod path;
mod position;
mod right_angles;
mod sensor;
mod smoothed;
mod trace;
mod two_feet;
mod walk;
mod warning;

pub use kestirim_import::inertial::Sample;

pub use self::check::check;
pub use self::choices::{DetectorKind, Options, SensorClass, TrackerKind};
pub use self::error::Error;
pub use self::live::{Follow, build};
pub use self::position::{Footprint, TrackPoint, position_at};
pub use self::right_angles::RightAngles;
pub use self::sensor::sensor_class;
pub use self::trace::{Moment, Trace, trace, without_updates};
pub use self::two_feet::BothFeet;
pub use self::walk::{Stride, Walk, walk};
pub use self::warning::sentences;

use crate::metrics::STANDARD_GRAVITY;
