//! Tests of the crate's public interface, in one program so that less is compiled and linked.

mod against_textbook;
mod covariance_forms;
mod filters;
mod inflate;
mod rails;
mod single_parts;
