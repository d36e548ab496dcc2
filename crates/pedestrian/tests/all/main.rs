//! Tests of the crate from outside, in one program: less is compiled and linked.

mod common;
mod offline;
mod stream;
mod walk;
