#![doc = include_str!("../README.md")]
#![no_std]
extern crate std;

mod channel;
mod config;
mod epoch;
mod error;
mod filter;
mod start;

pub use config::{Config, Deviation, Motion};
pub use epoch::Sighting;
pub use error::Error;
pub use filter::{PppFilter, Solution, states};
