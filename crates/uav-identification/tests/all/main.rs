//! Flights of a known model.

mod refusals;
mod simulated;
mod synthetic;
