//! Tests of the crate from outside, in one program: less is compiled and linked.

mod adaptive;
mod anything;
mod filters;
mod many_outliers;
mod settings;
mod single_parts;
mod uwb;
mod weights;
