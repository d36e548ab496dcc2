//! Tests of the crate from outside, in one program: less is compiled and linked.

mod augmented;
mod dice;
mod flights;
mod runs;
mod scheduled;
