//! Helpers shared by the tests across crates.

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

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct FirstPage;
