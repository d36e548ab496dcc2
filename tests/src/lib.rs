//! What the tests across crates share.

pub mod book;
pub mod common_scenario;
#[path = "../firmware/images/src/design.rs"]
pub mod design;
pub mod gnss;
#[path = "../firmware/images/src/ppp.rs"]
pub mod ppp;
pub mod recordings;
pub mod robot;
pub use target_bench::uav;

/// The example of the first page compiles.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct FirstPage;
