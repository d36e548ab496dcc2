//! Reads arbitrary bytes as a log of a flight: they are refused with a sentence, or read.

use kestirim_import::{Options, flight};

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    if let Err(refusal) = flight::read(bytes, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
}
