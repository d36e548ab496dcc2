//! Tests of the C interface from C: the header is what cbindgen generates from the sources and compiles without a
//! warning, and C programs on a computer and on three emulated targets print bit for bit what the crates compute here.
//!
//! Tests for which a machine lacks the tools print SKIPPED. With `KESTIRIM_REQUIRE_C=1` a missing compiler or emulator
//! is a failure, with `KESTIRIM_REQUIRE_DATA=1` missing recordings are.

mod broadcast;
mod corrections;
mod header;
mod pointers;
mod programs;
mod reference;
mod streams;
mod tools;

#[path = "../../../../tests/firmware/images/src/ppp.rs"]
#[allow(dead_code, unreachable_pub, clippy::pedantic)]
mod ppp;
