#![doc = include_str!("../README.md")]
#![no_std]

mod broadcast;
mod channel;
mod clock_jump;
mod collected;
mod config;
mod consistency;
mod displacement;
mod error;
mod estimator;
mod filter;
mod fixer;
mod least_squares;
mod line;
mod median;
mod observation;
mod phase_monitor;
mod report;
mod rest;
mod running;
mod single_point;
#[cfg(feature = "serde")]
mod snapshot;
mod solution;
mod ssr;
mod start;
mod states;
mod weighting;

pub use broadcast::{Broadcast, MessagePart, NoEphemeris};
pub use config::{Config, Deviation, Motion};
pub use error::Error;
pub use estimator::Estimator;
pub use filter::PppFilter;
pub use fixer::{AmbiguityFixer, FixedSolution, PhaseBias};
pub use observation::SatelliteObservation;
pub use single_point::{CodeObservation, single_point};
pub use solution::{Contradiction, Health, SatelliteReport, Slipped, Solution};
pub use ssr::{Corrected, Timed, corrected};
pub use states::states;
pub use weighting::{Lean, Weighting};
