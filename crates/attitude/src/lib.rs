#![doc = include_str!("../README.md")]
#![no_std]

mod ahrs;
mod orientation;
#[cfg(feature = "serde")]
mod snapshot;

pub use ahrs::{Ahrs, Error, Gains};
pub use orientation::Orientation;
