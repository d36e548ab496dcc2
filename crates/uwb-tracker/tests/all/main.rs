//! Tests of the crate from outside, in one program: less is compiled and linked.

mod anything;
mod calm;
mod common;
mod differences;
mod height;
mod mirror;
mod published;
mod single_parts;
mod tracking;
mod wheels;
