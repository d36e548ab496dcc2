//! Tests of the crate's public interface, in one program so that less is compiled and linked.

mod adaptive;
mod anything;
mod filters;
mod many_outliers;
mod settings;
mod single_parts;
mod uwb;
mod weights;
