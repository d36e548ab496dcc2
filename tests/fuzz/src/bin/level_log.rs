//! Any bytes as a log of levels and places: refused with a sentence, read, or no such file.
#![no_main]

use kestirim_import::{Options, levels};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(refusal) = levels::read(bytes, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
});
