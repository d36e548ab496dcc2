//! A foot-mounted IMU, as an example application: reads an MPU-9250, tracks the foot, logs the samples as the paper's
//! Razor did, and sends samples, positions and footprints as telemetry.
//!
//! [`App`] works on any board whose peripherals have the traits of `embedded-hal` 1.0: an I²C bus, a file and a serial
//! port. `tests/firmware/apps/pedestrian` is the program for one board.

#![no_std]
#![expect(missing_debug_implementations, reason = "the driver of the sensor has none")]

mod app;
mod error;
mod imu;
mod log;
mod razor;

pub use app::{App, Event, Summary};
pub use error::Error;
pub use imu::{Counts, Imu, SensorError};
