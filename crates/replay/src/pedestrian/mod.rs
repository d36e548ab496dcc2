//! A walk with a sensor on the foot.
//!
//! [`walk`] makes a [`Walk`] of [`Sample`]s as the [`Options`] say, [`trace`] keeps velocity, attitude and stance of every
//! sample, too. [`Walk::correct_heading`] takes the drift of the heading back where the log has a magnetometer, [`sensor_class`] what kind
//! of sensor it was. [`build`] makes what follows a walk while it comes. Frame: *room*, z up, x as the foot pointed at
//! the start.

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
