#![doc = include_str!("../README.md")]
#![no_std]

mod error;
mod frame;
mod message;
mod receiver;
mod sequence;
#[cfg(feature = "embedded-io")]
mod transmitter;

pub use error::Error;
pub use frame::{CAPACITY, Origin, VERSION, VERSION_OF_FLEETS, encode, encode_from};
pub use message::{
    EstimateHealth, Flight, Footprint, GlobalPosition, Health, Imu, Message, PathLoss, Position,
    Range, State,
};
pub use receiver::{Counts, Frame, Frames, Receiver};
pub use sequence::{Order, RESUMED_AFTER};
#[cfg(feature = "embedded-io")]
pub use transmitter::{DeviceTransmitter, Transmitter};
