//! Tests of the crate from outside, in one program: less is compiled and linked.

mod anything;
mod common;
mod inertial;
mod magnetometer;
