//! An unmanned aeroplane's observer, as an example application: reads pitch rate and pitch from a BNO055 and the
//! airspeed from an MS4525DO at a Pitot tube, estimates the longitudinal state, and sends both as telemetry.
//!
//! [`App`] works on any board whose peripherals have the traits of `embedded-hal` 1.0: two I²C buses (or one that is
//! shared) and a serial port. The observer's gains are computed at compile time: [`aeroplane`].

#![no_std]
#![expect(missing_debug_implementations, reason = "the drivers of the sensors have none")]

// The images measure the observer of the same aeroplane.
#[path = "../../../firmware/images/src/uav.rs"]
pub mod aeroplane;
mod app;
mod error;
mod sensors;

pub use app::{App, Event, INTERVAL_MS};
pub use error::Error;
pub use sensors::{SensorError, Sensors};
