//! Flights whose model is known.

mod refusals;
mod simulated;
mod synthetic;
