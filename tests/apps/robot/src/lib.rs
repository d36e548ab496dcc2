//! A robot among four ultra-wideband anchors, as one would write it: a DW1000 asks the anchors one after
//! the other, a BNO055 feels whether the robot stands, the tracker computes in fixed point, and frames of
//! telemetry tell a host where it is.
//!
//! Everything is behind traits of `embedded-hal` 1.0 and `embedded-io`. Its programs are `robot-esp32c3`, for
//! the silicon, and `robot-firmware`, for QEMU, where `robot-world` plays the devices. [`Robot::step`] is the
//! loop's body; the room is in [`SITES`].
#![no_std]
#![expect(missing_debug_implementations, reason = "drivers have none")]

mod error;
mod imu;
pub mod message;
mod radio;
mod robot;
mod room;

pub use error::{AccelerationError, Error, RangeError};
pub use imu::{Imu, ImuError};
pub use radio::{Radio, RadioError, Tag};
pub use robot::{Robot, Step};
pub use room::{HEIGHT, SITES, Site, TAG};

/// The number of a processor without a floating-point unit: 20 bits after the point.
pub type Number = kestirim_scalar::Q12_20;
