#![doc = include_str!("../README.md")]
#![no_std]

mod components;
mod double;
mod fixed;
mod float;
#[cfg(feature = "fixed")]
mod interop;
mod single;
mod traits;

pub use components::{Columns, Components};
pub use fixed::{Fixed, FixedDivisor, Q8_24, Q12_20, Q16_16};
pub use traits::Scalar;
