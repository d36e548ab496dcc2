//! What the simulation draws.

pub mod scenario;
