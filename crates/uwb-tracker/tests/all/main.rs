//! Integration tests in a single program, so that less is compiled and linked.

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
