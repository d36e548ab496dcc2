//! Everything of `kestirim-arithmetic`.

use kestirim_arithmetic::sqrt;

use super::values::{any, call_each, keep};

fn roots() {
    keep(sqrt(any(2.0)));
}

/// Calls it all.
pub fn run() {
    call_each([roots]);
}
