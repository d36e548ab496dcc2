//! Integration tests in a single program, so that less is compiled and linked.

mod aerosonde;
mod airframes;
mod plants;
