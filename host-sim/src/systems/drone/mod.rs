//! A drone base station that finds and follows a user on the ground.
//!
//! `trajectory` and `scenario` make measurements; `static_user` and `moving_user` run one cell of the thesis'
//! tables; `experiment` runs them all; `flight` and `area` read recordings, in which
//! `search` finds the user for a [replay](replay::Replay).
//!
//! Frame: a plane in metres (such as east and north), heights above the user.

#![expect(
    clippy::missing_panics_doc,
    reason = "what is expected holds for all that the command line lets through"
)]

pub mod area;
pub mod beyond;
pub mod chapter;
pub mod cloud;
pub mod experiment;
pub mod explorer;
pub mod film;
pub mod flight;
pub mod moving_user;
pub mod online;
pub mod options;
pub mod replay;
pub mod report;
pub mod scenario;
mod search;
pub mod static_user;
mod survey;
pub mod sweeps;
pub mod trajectory;

/// What `host-sim list` says of this system.
pub(super) const DESCRIPTION: &str = "\
drone       where a user on the ground is, from the path loss to a drone
  scenario  a user who stays in 2000 m × 2000 m, measured from a circle or a grid
  scenario  a user who walks a circle in 4000 m × 4000 m, followed by the drone
  log       CSV with columns t,x,y,h and path_loss_db or rssi_db in s, m and dB
  area      CSV with columns x,y in m: the corners of a polygon
  truth     CSV with columns x,y in m, one line";
