//! A robot among four ultra-wideband anchors, as an example application: a DW1000 ranges to one anchor after the other,
//! a BNO055 detects whether the robot stands, the tracker computes in fixed point, and telemetry frames report the
//! position to a host.
//!
//! All hardware is accessed through the traits of `embedded-hal` 1.0 and `embedded-io`. The programs are
//! `robot-esp32c3`, for the chip, and `robot-firmware`, for QEMU, where `robot-world` simulates the devices.
//! [`Robot::step`] is the body of the loop; the room is in [`SITES`].
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

/// The number type for a processor without a floating-point unit: 20 fractional bits.
pub type Number = kestirim_scalar::Q12_20;
