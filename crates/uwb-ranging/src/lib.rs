#![doc = include_str!("../README.md")]
#![no_std]

mod error;
mod least_squares;
mod range;
mod room;
mod symmetric;

pub use error::Error;
pub use least_squares::{Fix, Huber, Observation, Solver};
pub use range::{ExpectedRange, expected_range};
pub use room::Room;
