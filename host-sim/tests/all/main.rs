//! The tests of the program, one module per subject, in one binary: linking the library a dozen times took longer than
//! most of the tests. `cargo test -p host-sim --test all robot_cli::` runs those of one module.
//!
//! Separate binaries are `page`, which alone needs a browser's protocol, and `live_flood`, which measures losses while
//! nothing else keeps the machine busy.

mod calibrate_cli;
mod check_cli;
mod cli;
#[cfg(target_os = "linux")]
mod completions;
mod design_cli;
mod drone_cli;
mod fetch_cli;
mod foreign_flights;
mod foreign_logs;
mod foreign_messages;
mod foreign_senders;
mod gnss_cli;
mod gnss_recorded_cli;
mod gnss_refusals_cli;
mod live_cli;
mod live_devices;
mod live_senders;
mod live_systems;
mod outputs_cli;
#[path = "../program/mod.rs"]
mod program;
mod radio_cli;
mod recorded_cli;
mod robot_cli;
mod room;
mod scripts;
#[path = "../sender/mod.rs"]
mod sender;
mod serve_cli;
mod station;
mod terminal;
mod uav_cli;
