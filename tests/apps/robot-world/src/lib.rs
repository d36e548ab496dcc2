//! Simulates the robot's surroundings under an emulator: a DW1000 and a BNO055 at register level, and anchors whose
//! answers yield the ranges of a stream.
#![no_std]

mod anchors;
mod bno055;
mod dw1000;
mod spi;
mod world;

pub use bno055::I2cBus;
pub use spi::{ChipSelect, Spi};
pub use world::{Sample, World};
