#![doc = include_str!("../README.md")]
#![no_std]

mod alignment;
mod clipping;
mod clock;
pub mod detector;
mod engine;
mod error;
mod health;
mod magnetic;
mod navigator;
mod offline;
mod sample;
mod sensor;
#[cfg(feature = "serde")]
mod snapshot;
mod stride;
mod tracker;
mod uncertainty;

pub use alignment::Alignment;
pub use clipping::MissedTurn;
pub use error::Error;
pub use health::Warnings;
pub use kestirim_health::{Health, Reason};
pub use magnetic::MagneticHeading;
pub use navigator::{Ekf, Lite, Navigator, Step, ZeroVelocity};
pub use offline::OfflineTracker;
pub use sample::ImuSample;
pub use sensor::SensorClass;
pub use stride::Stride;
pub use tracker::{Config, EkfTracker, Estimate, LiteTracker, Tracker};
pub use uncertainty::PathUncertainty;
