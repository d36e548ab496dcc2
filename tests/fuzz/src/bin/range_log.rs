//! Reads arbitrary bytes as a log of ranges: they are refused with a sentence, or read.
#![no_main]

use kestirim_import::{Options, ranging};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let anchors = ["A1", "A2", "0", "1"].map(str::to_owned);
    if let Err(refusal) = ranging::read(bytes, &anchors, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
});
