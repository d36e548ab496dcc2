#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

mod carried;
mod current;
mod dense;
mod disturbance;
mod error;
mod full_order;
mod increment;
mod integers;
mod plant;
mod predictor;
mod reduced;
mod rows;
mod saturation;
#[cfg(feature = "serde")]
mod snapshot;

pub use current::{CurrentGains, CurrentObserver};
pub use disturbance::{DisturbanceGains, DisturbanceObserver};
pub use error::Error;
pub use plant::Plant;
pub use predictor::{Predictor, PredictorGains};
pub use reduced::{ReducedGains, ReducedObserver};
pub use saturation::Saturation;
