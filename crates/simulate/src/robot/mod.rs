//! What the simulation draws.

pub mod radio;
pub mod scenario;
