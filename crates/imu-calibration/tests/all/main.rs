//! Integration tests in one program, so that less is compiled and linked.

mod anything;
mod common;
mod inertial;
mod magnetometer;
