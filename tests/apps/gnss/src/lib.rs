//! A receiver of carrier phases that finds its place to centimetres, as one would write it: a u-blox module tells
//! what it observes on L1 and L2 (UBX-RXM-RAWX), a modem hands on lines of precise orbits and clocks as services
//! publish them (SP3 and RINEX clock files), a filter finds the place, and frames of telemetry tell a host.
//!
//! Both are behind `embedded-io`. [`App::poll`] is the loop's body; [`site`] is what is to be changed.
#![no_std]

mod app;
mod calendar;
mod error;
mod lines;
mod observations;
mod products;
pub mod site;

pub use app::{App, Epoch, STATES, Unused, VISIBLE};
pub use error::Error;
pub use products::Unusable;
