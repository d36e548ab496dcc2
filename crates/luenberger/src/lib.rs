#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

mod carried;
mod current;
mod dense;
mod disturbance;
mod error;
mod integers;
mod plant;
mod predictor;
mod reduced;
mod rows;
mod saturation;

pub use current::{Current, CurrentGains};
pub use disturbance::{Disturbance, DisturbanceGains};
pub use error::Error;
pub use plant::Plant;
pub use predictor::{Predictor, PredictorGains};
pub use reduced::{Reduced, ReducedGains};
pub use saturation::Saturation;
