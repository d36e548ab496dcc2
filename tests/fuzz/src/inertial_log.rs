//! Reads arbitrary bytes as a log of an inertial sensor: they are refused with a sentence, or read.

use kestirim_import::{Options, inertial};

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    if let Err(refusal) = inertial::read(bytes, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
}
