#![doc = include_str!("../README.md")]

mod chain;
mod clipped;
pub mod drone;
mod finding;
pub mod gnss;
pub mod metrics;
pub mod pedestrian;
pub mod robot;
mod scalar;
mod stored;
pub mod uav;

pub use self::finding::Finding;
pub use self::scalar::ScalarKind;
pub use self::stored::{Number, Stored};
#[cfg(feature = "serde")]
pub use self::uav::KnownAirframe;
