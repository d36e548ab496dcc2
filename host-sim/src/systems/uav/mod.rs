//! The longitudinal motion of a fixed-wing aircraft, seen by Luenberger observers and Kalman filters.
//!
//! `plant` has the aircraft and what of them is measured, `scenario` flies them; `design` finds gains, which
//! `kestirim-uav-estimator` runs in any scalar. `experiment` repeats the thesis: `responses` (its chapter 5),
//! `catching` and `accuracy` (chapter 6), `claims` (chapter 7). `log` and `model` read what a
//! [replay](replay::Replay) needs, `follow` runs the estimators along it.
//!
//! States α, q, V, θ and inputs δe, δt are deviations from the flight that the model was linearised at; rad,
//! rad/s, m/s.

#![expect(
    clippy::missing_panics_doc,
    reason = "the designs of the experiment are for the plants of the experiment"
)]

pub mod accounts;
pub mod accuracy;
pub mod catching;
pub mod chapter;
pub mod claims;
pub mod design;
pub mod experiment;
pub mod explorer;
pub mod follow;
pub mod log;
pub mod model;
pub mod options;
pub mod plant;
pub mod recording;
pub mod replay;
pub mod report;
pub mod responses;
pub mod scenario;
mod streams;
pub mod trip;

/// What `host-sim list` says of this system.
pub(super) const DESCRIPTION: &str = "\
uav         angle of attack, pitch rate, airspeed and pitch angle of a fixed-wing aircraft
  scenario  10 s of an Aerosonde, of the thesis' aircraft and of a Navion, with constant and sine inputs,
            with and without noise
  log       CSV with columns t,delta_e,delta_t and some of alpha,q,V,theta in s, rad, rad/s, m/s
  model     P1, P2, P3, or JSON: A (4 × 4), B (4 × 2), perhaps C with the names of its outputs, trim {x, u}, and
            h (s) if A and B are of discrete time
  truth     CSV with columns t and some of alpha,q,V,theta";
