//! What the tests across crates share.

#[path = "../firmware/images/src/design.rs"]
pub mod design;
pub mod firmware;
pub mod gnss;
#[path = "../firmware/images/src/ppp.rs"]
pub mod ppp;
pub mod recordings;
pub mod robot;
#[path = "../firmware/images/src/uav.rs"]
pub mod uav;
