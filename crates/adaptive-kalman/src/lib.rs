#![doc = include_str!("../README.md")]
#![no_std]

mod adaptive;
mod error;
mod learning;
mod measurement_noise;
mod process_noise;
mod published;
#[cfg(feature = "serde")]
mod snapshot;

pub use adaptive::AdaptiveKalman;
pub use error::Error;
pub use learning::Learning;
pub use measurement_noise::MeasurementNoise;
pub use process_noise::ProcessNoise;
pub use published::PublishedAdaptiveKalman;
