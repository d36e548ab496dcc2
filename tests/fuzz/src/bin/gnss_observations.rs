//! `fuzz::gnss_observations` for libFuzzer.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| fuzz::gnss_observations::feed(bytes));
