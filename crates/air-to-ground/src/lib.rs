#![doc = include_str!("../README.md")]
#![no_std]

mod channel;
mod environment;
mod error;
mod measurement;
mod rotor;

pub use channel::{Channel, PathLoss};
pub use environment::{Environment, Propagation};
pub use error::Error;
pub use measurement::Measurement;
pub use rotor::Rotor;
