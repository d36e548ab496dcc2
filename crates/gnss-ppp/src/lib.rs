#![doc = include_str!("../README.md")]
#![no_std]

mod antenna;
mod astronomy;
mod attitude;
mod bodies;
pub mod constants;
mod geodesy;
mod ocean_loading;
mod relativity;
mod solid_tide;
mod time;
mod troposphere;
mod wind_up;

pub use antenna::Pattern;
pub use astronomy::greenwich_sidereal_time;
pub use attitude::BodyAxes;
pub use bodies::Bodies;
pub use geodesy::{Direction, Geodetic};
pub use ocean_loading::OceanLoading;
pub use relativity::{carried_along, eccentricity_clock, sagnac, shapiro_delay};
pub use solid_tide::solid_tide;
pub use time::GpsTime;
pub use troposphere::{Mapping, Troposphere, zenith_hydrostatic, zenith_wet};
pub use wind_up::wind_up;
