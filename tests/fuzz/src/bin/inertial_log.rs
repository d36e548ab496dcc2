//! Reads arbitrary bytes as a log of an inertial sensor: they are refused with a sentence, or read.
#![no_main]

use kestirim_import::{Options, inertial};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(refusal) = inertial::read(bytes, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
});
