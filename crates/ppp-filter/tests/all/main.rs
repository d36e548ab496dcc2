//! Tests of the crate from outside, in one program: less is compiled and linked.

mod filter;
mod lean;
mod moved;
mod single_point;
mod sky;
mod systems;
