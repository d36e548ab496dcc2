#![doc = include_str!("../README.md")]
#![no_std]

mod channel;
mod collected;
mod config;
mod epoch;
mod error;
mod estimator;
mod filter;
mod line;
mod report;
mod running;
mod solution;
mod start;
mod states;
mod watch;

pub use config::{Config, Deviation, Motion};
pub use epoch::Sighting;
pub use error::Error;
pub use estimator::Estimator;
pub use filter::PppFilter;
pub use solution::{Health, SatelliteReport, Slipped, Solution};
pub use states::states;
