//! Reads arbitrary bytes as observations: RINEX, Compact RINEX, receiver streams, compressed or not.
#![no_main]

use kestirim_gnss_files::{Observations, Text};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = Text::unpack("a", bytes.to_vec()) else { return };
    let _ = Observations::parse(&text);
});
