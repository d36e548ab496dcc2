#![doc = include_str!("../README.md")]
#![no_std]

pub mod accuracy;
pub mod beidou;
mod bits;
mod collector;
mod crc;
mod ephemeris;
mod frame;
pub mod galileo;
pub mod gps;
pub mod ssr;

pub use bits::Bits;
pub use collector::{Collector, Part};
pub use crc::crc_24q;
pub use ephemeris::Ephemeris;
pub use frame::{frame_data, frame_length};
