//! The C interface, from C: the header is what cbindgen makes of the sources and compiles without a warning, and C
//! programs tell on a computer and on three emulated targets the very bits that the crates compute here.
//!
//! What a machine does not have is said: SKIPPED. With `KESTIRIM_REQUIRE_C=1` a missing compiler or emulator is
//! a failure, with `KESTIRIM_REQUIRE_DATA=1` missing recordings are.

mod header;
mod pointers;
mod programs;
mod reference;
mod streams;
mod tools;

#[path = "../../../../tests/firmware/images/src/ppp.rs"]
#[allow(dead_code, unreachable_pub, clippy::pedantic)]
mod ppp;
