//! Tests of the crate from outside, in one program: less is compiled and linked.

mod byers_nash;
mod equations;
mod placement;
