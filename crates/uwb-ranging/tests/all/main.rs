//! Tests of the crate from outside, in one program: less is compiled and linked.

mod anchors;
mod downlink;
mod levels;
mod positions;
mod two_way;
