//! A drone that locates a user in a city, as an example application: a satellite receiver gives its own position, a
//! `LoRa` module the received level of the user's beacon, a particle filter estimates the user's position, and
//! telemetry frames report it to a host.
//!
//! Both modules are accessed through `embedded-io`; the source of randomness is passed in. [`App::poll`] is the body of
//! the loop; [`site`] is the part to adapt.
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

/// The number of particles: 5.6 kB, of 32 kB of RAM.
pub const PARTICLES: usize = 200;
