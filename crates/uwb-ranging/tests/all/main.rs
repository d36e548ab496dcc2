//! Integration tests in a single program, so that less is compiled and linked.

mod anchors;
mod downlink;
mod levels;
mod positions;
mod two_way;
