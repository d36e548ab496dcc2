#![doc = include_str!("../README.md")]
#![no_std]

mod decorrelated;
mod error;
mod search;
mod square;

pub use decorrelated::Decorrelated;
pub use error::Error;
pub use search::Fix;
