//! Flights of known aircraft, with the noise of their sensors.

pub mod flight;
pub mod plant;
pub mod scenario;
