//! Tests of the crate from outside, in one program: less is compiled and linked.

mod against_textbook;
mod covariance_forms;
mod filters;
mod inflate;
mod single_parts;
