//! The systems, one folder each, with the same rooms.

pub mod drone;
pub mod gnss;
pub mod pedestrian;
pub mod robot;
pub mod uav;

use crate::system::AnySystem;

/// Every system, in the order in which they run: the one list.
pub static ALL: [&dyn AnySystem; 5] =
    [&pedestrian::Pedestrian, &robot::Robot, &drone::Drone, &uav::Uav, &gnss::Gnss];
