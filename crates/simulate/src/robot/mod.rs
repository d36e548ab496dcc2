//! The simulated office, its paths and its radios.

pub mod day;
pub mod radio;
pub mod scenario;
