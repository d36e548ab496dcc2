//! The longitudinal motion of a fixed-wing aircraft, seen by Luenberger observers and Kalman filters.
//!
//! `plant` has the aircraft and what of them is measured, `scenario` flies them; `design` finds gains, `estimator`
//! runs them in any scalar. `experiment` repeats the thesis: `responses` (its chapter 5), `catching` and
//! `accuracy` (chapter 6), `claims` (chapter 7). `log` and `model` read what a [replay](replay::Replay) needs.
//!
//! States α, q, V, θ and inputs δe, δt are deviations from the flight that the model was linearised at; rad,
//! rad/s, m/s.

#![expect(
    clippy::missing_panics_doc,
    reason = "the designs of the experiment are for the plants of the experiment"
)]

pub mod accuracy;
pub mod catching;
pub mod claims;
pub mod design;
pub mod estimator;
pub mod experiment;
pub mod plant;
pub mod report;
pub mod responses;
pub mod scenario;

/// What `host-sim list` says of this system.
pub(super) const DESCRIPTION: &str = "\
uav         angle of attack, pitch rate, airspeed and pitch angle of a fixed-wing aircraft
  scenario  10 s of an Aerosonde, of the thesis' aircraft and of a Navion, with constant and sine inputs,
            with and without noise";
