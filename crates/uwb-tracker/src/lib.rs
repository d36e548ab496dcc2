#![doc = include_str!("../README.md")]
#![no_std]

mod config;
mod differences;
mod epoch;
mod error;
mod health;
mod height;
mod link;
mod measurement;
mod mirror;
mod motion;
mod pace;
mod published;
mod sample;
#[cfg(feature = "serde")]
mod snapshot;
mod start;
mod stillness;
mod take_in;
mod tracker;
pub mod wheel_noise;
mod wheels;

pub use config::Config;
pub use differences::DifferenceTracker;
pub use epoch::{EpochMethod, EpochSolver};
pub use error::Error;
pub use health::{Health, State};
pub use height::HeightFinder;
pub use kestirim_uwb_ranging::Room;
pub use link::Anchor;
pub use published::{PublishedConfig, PublishedOutcome, PublishedTracker};
pub use sample::{DifferenceSample, InertialSample, OdometrySample, Outcome, RangeSample, Report};
pub use tracker::{
    CalibratedPlaneTracker, CalibratedSpaceTracker, PlaneTracker, SpaceTracker, Tracker,
};
pub use wheels::WheelTracker;
