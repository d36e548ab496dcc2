#![doc = include_str!("../README.md")]
#![no_std]

mod double;
mod fixed;
mod float;
#[cfg(feature = "fixed")]
mod interop;
mod single;
mod traits;

pub use fixed::{Fixed, FixedDivisor, Q8_24, Q12_20, Q16_16};
pub use traits::Scalar;
