//! Everything of `kestirim-arithmetic`.

use super::values::{any, call_each, keep};

fn roots() {
    keep(kestirim_arithmetic::sqrt(any(2.0)));
}

/// Calls it all.
pub fn run() {
    call_each([roots]);
}
