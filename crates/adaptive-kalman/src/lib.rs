#![doc = include_str!("../README.md")]
#![no_std]

mod adaptive;
mod error;
mod learning;
mod measurement_noise;
mod printed;
mod process_noise;

pub use adaptive::AdaptiveKalman;
pub use error::Error;
pub use learning::Learning;
pub use measurement_noise::{MeasurementNoise, learnt};
pub use printed::PrintedAdaptiveKalman;
pub use process_noise::ProcessNoise;
