//! Reads arbitrary bytes as observations: RINEX, Compact RINEX, receiver streams, compressed or not.

use kestirim_gnss_files::{Observations, Text};

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    let Ok(text) = Text::unpack("a", bytes.to_vec()) else { return };
    let _ = Observations::parse(&text);
}
