#![doc = include_str!("../README.md")]

pub mod drone;
pub mod gnss;
pub mod pedestrian;
pub mod random;
pub mod robot;
pub mod uav;
