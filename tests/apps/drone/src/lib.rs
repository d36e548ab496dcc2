//! A drone that looks for a user in a city, as one would write it: a satellite receiver tells where it is, a
//! `LoRa` module how strongly the user's beacon came in, a particle filter where the user must be, and frames of
//! telemetry tell a host.
//!
//! Both modules are behind `embedded-io`; the source of randomness is handed in. [`App::poll`] is the loop's
//! body; [`site`] is what is to be changed.
#![no_std]

mod app;
mod beacon;
mod error;
mod gps;
mod lines;
pub mod site;

pub use app::{App, Event};
pub use beacon::Beacon;
pub use error::Error;
pub use gps::Degree;

/// Particles: 5.6 kB, of 32 kB of RAM.
pub const PARTICLES: usize = 200;
