#![doc = include_str!("../README.md")]
#![no_std]

mod block;
mod covariance;
mod driven;
mod error;
mod gate;
mod gaussian;
mod inflate;
mod innovation;
mod model;
mod motion;
mod row;
#[cfg(feature = "serde")]
mod snapshot;
mod steady_state;

pub use block::BlockInnovation;
pub use covariance::Covariance;
pub use driven::Driven;
pub use error::Error;
pub use gate::{Gate, Verdict};
pub use gaussian::Gaussian;
pub use innovation::{Innovation, Weighed};
pub use model::{Linear, LinearObservation, Observation, Process};
pub use motion::ConstantVelocity;
pub use row::SparseRow;
pub use steady_state::{SteadyState, steady_state};
