//! The robot's surroundings under an emulator: a DW1000 and a BNO055 at the level of their registers,
//! and anchors that answer in such a way that the ranges of a stream come out.
#![no_std]

mod anchors;
mod bno055;
mod dw1000;
mod spi;
mod world;

pub use bno055::I2cBus;
pub use spi::{ChipSelect, Spi};
pub use world::{Sample, World};
