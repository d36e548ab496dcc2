//! Reads arbitrary bytes as a log of a flight: they are refused with a sentence, or read.
#![no_main]

use kestirim_import::{Options, flight};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(refusal) = flight::read(bytes, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
});
