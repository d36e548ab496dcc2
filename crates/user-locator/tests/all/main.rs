//! Integration tests in a single program, so that less is compiled and linked.

mod area;
mod ground;
mod heading;
mod users;
mod waypoint;
