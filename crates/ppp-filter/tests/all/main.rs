//! Integration tests in one program, so that less is compiled and linked.

mod broadcast;
mod filter;
mod lean;
mod moved;
mod single_point;
mod sky;
mod ssr;
mod systems;
