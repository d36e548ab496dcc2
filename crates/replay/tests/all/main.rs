//! Tests of what the crate offers, with recordings, made-up walks and rooms. They are separate from the tests of single
//! functions, so that those are built without the trackers.

mod closed;
mod right_angles;
mod robot_check;
mod robot_smoother;
mod survey;
mod two_feet;
#[cfg(feature = "serde")]
mod uav_grids;
#[cfg(feature = "serde")]
mod uav_live;
