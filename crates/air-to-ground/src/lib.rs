#![doc = include_str!("../README.md")]
#![no_std]

mod channel;
mod contaminated;
mod environment;
mod error;
mod free_space;
mod heading;
mod likelihood;
mod measurement;
mod open_ground;
mod rotor;
#[cfg(feature = "serde")]
mod snapshot;

pub use channel::{Channel, PathLoss};
pub use contaminated::Contaminated;
pub use environment::{Environment, Propagation};
pub use error::Error;
pub use free_space::{Antennas, FreeSpace, LevelPrior};
pub use heading::Heading;
pub use likelihood::Likelihood;
pub use measurement::Measurement;
pub use open_ground::{GroundFit, OpenGround, Pattern, SUPPOSITIONS, Supposition};
pub use rotor::Rotor;
