#![doc = include_str!("../README.md")]
#![no_std]

mod airframe;
mod derivatives;
mod dual;
mod error;
mod flight;
mod lateral;
mod plant;
#[cfg(feature = "serde")]
mod published;
mod solve;
mod state_space;

pub use airframe::{Airframe, Drag, Inertia, Lift, Pitch, Propeller, SideCoefficients, Stall};
pub use derivatives::{LateralDerivatives, LongitudinalDerivatives};
pub use error::Error;
pub use flight::{SpecificForce, SteadyFlight, Trim};
pub use plant::{
    aerosonde, airspeed_and_pitch, full_state, navion, rate_airspeed_and_pitch, thesis_like,
};
pub use state_space::{Descriptor, StateSpace};
