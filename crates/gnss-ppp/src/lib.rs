#![doc = include_str!("../README.md")]
#![no_std]

mod antenna;
mod geodesy;
mod ocean_loading;
mod time;

pub use antenna::Pattern;
pub use geodesy::{Direction, Geodetic};
pub use ocean_loading::OceanLoading;
pub use time::GpsTime;
