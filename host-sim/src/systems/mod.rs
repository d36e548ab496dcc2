//! The systems, each in a folder of its own with the same structure.

pub mod drone;
pub mod gnss;
pub mod pedestrian;
pub mod robot;
pub mod uav;

use crate::system::AnySystem;

/// Every system, in the order in which they run. This is the only list of them.
pub static ALL: [&dyn AnySystem; 5] =
    [&pedestrian::Pedestrian, &robot::Robot, &drone::Drone, &uav::Uav, &gnss::Gnss];
