#![doc = include_str!("../README.md")]

mod antenna_model;
mod antennas;
mod biases;
mod clocks;
mod crinex;
mod earth_rotation;
mod error;
mod fields;
mod gzip;
mod kind;
mod navigation;
mod observations;
mod ocean_loading;
mod open;
mod orbits;
mod received;
mod satellites;
mod ssr;
mod streams;
mod system;
mod text;
mod time;
mod unserved;

#[cfg(test)]
mod mutations;
#[cfg(test)]
mod samples;

pub use antenna_model::AntennaModel;
pub use antennas::{Antenna, Antennas, PhaseCentre};
pub use biases::Biases;
pub use clocks::{ClockSample, Clocks};
pub use earth_rotation::EarthRotation;
pub use error::{Error, Warning};
pub use kind::Kind;
pub use navigation::{Ephemeris, Message, Navigation};
pub use observations::{Carriers, Epoch, Observations, Observed, Signal, Signals};
pub use ocean_loading::{OceanLoading, StationLoading};
pub use orbits::{OrbitSample, Orbits};
pub use received::Received;
pub use ssr::{SsrClock, SsrCorrection, SsrHeader, SsrOrbit, SsrSystem, SsrValues};
pub use system::{System, satellite_name};
pub use text::Text;
pub use time::GpsTime;
