//! Flights of known aircraft, with sensor noise.

pub mod design;
pub mod errors;
pub mod flight;
pub mod plant;
pub mod scenario;

pub use kestirim_uav_longitudinal::{airspeed_and_pitch, full_state, rate_airspeed_and_pitch};
