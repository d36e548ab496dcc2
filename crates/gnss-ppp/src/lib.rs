#![doc = include_str!("../README.md")]
#![no_std]

mod antenna;
mod attitude;
pub mod constants;
mod geodesy;
mod ocean_loading;
mod relativity;
mod time;
mod troposphere;
mod wind_up;

pub use antenna::Pattern;
pub use attitude::BodyAxes;
pub use geodesy::{Direction, Geodetic};
pub use ocean_loading::OceanLoading;
pub use relativity::{carried_along, eccentricity_clock, sagnac, shapiro_delay};
pub use time::GpsTime;
pub use troposphere::{Mapping, Troposphere, zenith_hydrostatic, zenith_wet};
pub use wind_up::wind_up;
