//! Tests of the crate from outside, in one program: less is compiled and linked.

mod aerosonde;
mod airframes;
mod plants;
