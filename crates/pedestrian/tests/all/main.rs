//! Integration tests in one program, so that less is compiled and linked.

mod common;
mod offline;
mod stream;
mod walk;
