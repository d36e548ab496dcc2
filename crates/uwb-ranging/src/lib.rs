#![doc = include_str!("../README.md")]
#![no_std]

mod dilution;
mod error;
mod least_squares;
mod quartiles;
mod range;
mod room;
mod symmetric;
mod trilateration;

pub use dilution::dilution_of_precision;
pub use error::Error;
pub use least_squares::{Fix, Huber, Observation, Solver};
pub use quartiles::Quartiles;
pub use range::{ExpectedRange, expected_range};
pub use room::Room;
pub use trilateration::Trilateration;
