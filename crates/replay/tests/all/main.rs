//! What replays whole recordings: it stands apart from what tests single functions, which so need not be built with all
//! trackers of all number types.

mod robot_smoother;
#[cfg(feature = "serde")]
mod uav_grids;
