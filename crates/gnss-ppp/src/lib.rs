#![doc = include_str!("../README.md")]
#![no_std]

mod astronomy;
mod bodies;
mod solid_tide;
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
mod clock;
mod correction;
mod observation;
mod orbit;
mod signal;
mod site;
mod slip;

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
pub use clock::{Clock, ClockSample, ClockState};
pub use correction::{Correction, Corrections};
pub use observation::{Expected, SatelliteState};
pub use orbit::{Orbit, OrbitSample, OrbitState};
pub use signal::{FREQUENCY, NARROW_LANE, NOISE_AMPLIFICATION, WAVELENGTH, WIDE_LANE, geometry_free, ionosphere_free, ionosphere_free_phase, melbourne_wuebbena};
pub use site::{Receiver, Site};
pub use slip::{Arc, Slip, SlipLimits};
pub use bodies::Bodies;
pub use solid_tide::solid_tide;
