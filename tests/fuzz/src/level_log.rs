//! Reads arbitrary bytes as a log of levels and positions: they are refused with a sentence, read, or not such a file.

use kestirim_import::{Options, levels};

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    if let Err(refusal) = levels::read(bytes, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
}
