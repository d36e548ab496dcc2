//! The longitudinal motion of an aeroplane: α, q, V, θ.
//!
//! [`Deviations`] are a [`Log`] minus the steady flight of its [`Model`]; [`Deviations::follow`] computes a
//! [`Followed`] from them according to the [`Options`], and [`build`] makes an estimator for a flight in progress.
//! Angles are radians, the airspeed m/s, times µs of the log's clock.

mod augmented;
mod check;
mod contradiction;
mod deviations;
mod error;
mod estimators;
mod extended;
mod live;
mod log;
mod model;
#[cfg(feature = "serde")]
mod model_file;
#[cfg(feature = "serde")]
mod model_grid;
#[cfg(feature = "serde")]
mod model_of_airframe;
mod noise;
mod options;
mod poles;

pub use self::augmented::MOST_EXTENDED_OUTPUTS;
pub use self::check::check;
pub use self::contradiction::Contradiction;
pub use self::deviations::Deviations;
pub use self::error::Error;
pub use self::estimators::{Assumed, Estimate, Followed, rows};
pub use self::extended::{Beside, Extended, Parts, Unknown};
pub use self::live::{Follow, build};
pub use self::log::{Log, Sample, Truth};
pub use self::model::{MOST_OUTPUTS, Model, Plant, STATE_COLUMNS, state_outputs};
#[cfg(feature = "serde")]
pub use self::model_file::{ModelFile, ModelFileError};
#[cfg(feature = "serde")]
pub use self::model_of_airframe::KnownAirframe;
pub use self::noise::Noise;
pub use self::options::{EstimatorKind, Options};
pub use self::poles::{FAST, MIDDLE, Poles, SLOW, discrete, faster};
