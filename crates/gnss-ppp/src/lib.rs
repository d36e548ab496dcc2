#![doc = include_str!("../README.md")]
#![no_std]

mod antenna;
mod astronomy;
mod attitude;
mod bodies;
mod clock;
pub mod constants;
mod correction;
mod ephemeris;
mod geodesy;
mod klobuchar;
mod observation;
mod ocean_loading;
mod orbit;
mod pole_tide;
mod relativity;
mod signal;
mod site;
mod slip;
mod solid_tide;
mod time;
mod trigonometry;
mod troposphere;
mod wind_up;

pub use antenna::Pattern;
pub use astronomy::greenwich_sidereal_time;
pub use attitude::BodyAxes;
pub use bodies::Bodies;
pub use clock::{Clock, ClockSample, ClockState};
pub use correction::{Correction, Corrections};
pub use ephemeris::Ephemeris;
pub use geodesy::{Direction, Geodetic};
pub use klobuchar::Klobuchar;
pub use observation::{Expected, SatelliteState};
pub use ocean_loading::OceanLoading;
pub use orbit::{Orbit, OrbitSample, OrbitState};
pub use pole_tide::pole_tide;
pub use relativity::{carried_along, eccentricity_clock, sagnac, shapiro_delay};
pub use signal::{Carriers, Constellation, FREQUENCY, WAVELENGTH};
pub use site::{Receiver, Site};
pub use slip::{Arc, Slip, SlipLimits};
pub use solid_tide::solid_tide;
pub use time::GpsTime;
pub use troposphere::{Mapping, Troposphere, gradient_mapping, zenith_hydrostatic, zenith_wet};
pub use wind_up::wind_up;
