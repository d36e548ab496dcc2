//! Tests of the crate from outside, in one program: less is compiled and linked.

mod area;
mod ground;
mod heading;
mod users;
mod waypoint;
