//! What the tests across crates share.

pub mod firmware;
pub mod recordings;
pub mod robot;
#[path = "../firmware/images/src/uav.rs"]
pub mod uav;
