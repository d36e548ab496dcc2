//! What the simulation draws.

pub mod day;
pub mod radio;
pub mod scenario;
