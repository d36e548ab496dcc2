//! Reads arbitrary bytes as a log of levels and positions: they are refused with a sentence, read, or not such a file.
#![no_main]

use kestirim_import::{Options, levels};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(refusal) = levels::read(bytes, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
});
