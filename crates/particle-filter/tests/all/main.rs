//! Tests of the crate from outside, in one program: less is compiled and linked.

mod offspring;
mod particles;
mod point_mass;
