#![doc = include_str!("../README.md")]
#![no_std]

mod error;
mod locator;
mod printed;

pub use error::Error;
pub use locator::Locator;
pub use printed::{PrintedLocator, PrintedSettings};
