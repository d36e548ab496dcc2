//! Integration tests in a single program, so that less is compiled and linked.

mod augmented;
mod dice;
mod flights;
mod runs;
mod scheduled;
