#![doc = include_str!("../README.md")]
#![no_std]

mod covariance;
mod discretise;
mod eigenvalues;
mod error;
mod extended;
mod lyapunov;
mod number;
mod observability;
mod orthonormal;
mod pair;
mod placement;
mod poles;
mod response;
mod riccati;
mod sequence;
mod solve;

pub use discretise::{Discrete, discrete_noise, tustin, zero_order_hold};
pub use eigenvalues::eigenvalues;
pub use error::{Error, Mode};
pub use lyapunov::{error_covariance, lyapunov};
pub use nalgebra::Complex;
pub use observability::{controllability, hidden_modes, observability};
pub use placement::{PlacedPole, Placement, place};
pub use response::{Response, StateSpace, singular_values};
pub use riccati::{Riccati, riccati};
