//! Tests that replay whole recordings. They are separate from the tests of single functions, so that those are built
//! without the trackers.

mod robot_check;
mod robot_smoother;
#[cfg(feature = "serde")]
mod uav_grids;
#[cfg(feature = "serde")]
mod uav_live;
