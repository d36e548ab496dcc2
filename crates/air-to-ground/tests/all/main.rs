//! Integration tests in a single program, so that less is compiled and linked.

mod scalars;
mod thesis;
