//! Reads arbitrary bytes as a log of ranges: they are refused with a sentence, or read.

use kestirim_import::{Options, ranging};

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    let anchors = ["A1", "A2", "0", "1"].map(str::to_owned);
    if let Err(refusal) = ranging::read(bytes, &anchors, &Options::default()) {
        assert!(!refusal.to_string().is_empty());
    }
}
